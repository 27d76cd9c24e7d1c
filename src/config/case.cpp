#include "config/case.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "config/node.hpp"

namespace bagnold::config {

struct Case::Impl {
  Node root;
  Resolved resolved;
  std::string directory, home;  // of the case, of the resolved case
};

Resolved::Entry& Resolved::entry(std::string_view key) {
  for (Entry& e : entries)
    if (e.key == key) return e;
  entries.push_back({std::string(key), Value{}});
  return entries.back();
}

namespace {

const Node::Table& table_of(const Node* node) {
  static const Node::Table none;
  if (const auto* table = std::get_if<Node::Table>(&node->value)) return *table;
  return none;
}

const Node* find(const Node* node, std::string_view key) {
  node->asked.insert(std::string(key));
  const auto& table = table_of(node);
  const auto at = table.find(std::string(key));
  if (at == table.end()) return nullptr;
  at->second.read = true;
  return &at->second;
}

const char* type_name(const Node& node) {
  constexpr const char* names[] = {"a boolean", "an integer", "a number", "a string", "an array", "a table"};
  return names[node.value.index()];
}

std::string join(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

// The value of `node` as T; nothing when it is of another type.
template <class T>
std::optional<T> as(const Node& node) {
  if constexpr (std::is_same_v<T, double>) {
    if (const auto* integer = std::get_if<std::int64_t>(&node.value)) return static_cast<double>(*integer);
    if (const auto* number = std::get_if<double>(&node.value)) return *number;
  } else if constexpr (std::is_same_v<T, std::vector<double>> || std::is_same_v<T, std::vector<std::string>>) {
    const auto* list = std::get_if<Node::List>(&node.value);
    if (list == nullptr) return {};
    T out;
    for (const Node& item : *list) {
      const auto element = as<typename T::value_type>(item);
      if (!element) return {};
      out.push_back(*element);
    }
    return out;
  } else {
    if (const auto* v = std::get_if<T>(&node.value)) return *v;
  }
  return {};
}

template <class T>
std::string expected() {
  if constexpr (std::is_same_v<T, bool>)
    return "true or false";
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return "an integer";
  else if constexpr (std::is_same_v<T, double>)
    return "a number";
  else if constexpr (std::is_same_v<T, std::string>)
    return "a string";
  else if constexpr (std::is_same_v<T, std::vector<double>>)
    return "an array of numbers";
  else
    return "an array of strings";
}

std::string in_unit(std::string_view unit) { return unit.empty() ? "" : fmt::format(" [{}]", unit); }

template <class T>
void check_range(const T& value, const Range& range, std::string_view unit, const Node& node) {
  const auto check = [&](double v) {
    if (!range.contains(v) || std::isnan(v))
      fail_at(node.place,
              fmt::format("{} = {:g} is out of range, expected {}{}", node.path, v, to_string(range), in_unit(unit)));
  };
  if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::int64_t>) check(static_cast<double>(value));
  if constexpr (std::is_same_v<T, std::vector<double>>)
    for (const double v : value) check(v);
}

}  // namespace

void Section::fail(std::string_view key, const std::string& what) const {
  const auto& table = table_of(node_);
  const auto at = table.find(std::string(key));
  const std::string full =
      node_->path.empty() ? std::string(key) : node_->path + (key.empty() ? "" : ".") + std::string(key);
  fail_at(at != table.end() ? at->second.place : node_->place, full.empty() ? what : full + ": " + what);
}

bool Section::has(std::string_view key) const { return table_of(node_).contains(std::string(key)); }
void Section::ask(std::string_view key) const { node_->asked.insert(std::string(key)); }
std::string Section::path() const { return node_->path; }

std::vector<std::string> Section::keys() const {
  std::vector<std::string> out;
  for (const auto& [key, value] : table_of(node_)) out.push_back(key);
  return out;
}

Section Section::child(std::string_view key) const {
  auto& entry = resolved_->entry(key);
  if (!std::holds_alternative<std::unique_ptr<Resolved>>(entry.content)) entry.content = std::make_unique<Resolved>();
  Resolved* resolved = std::get<std::unique_ptr<Resolved>>(entry.content).get();
  const Node* node = find(node_, key);
  if (node == nullptr) {
    // An absent table still has a path, so that a missing required key in it can be named.
    auto& absent = node_->absent[std::string(key)];
    if (absent == nullptr) {
      absent = std::make_unique<Node>();
      absent->path = node_->path.empty() ? std::string(key) : node_->path + "." + std::string(key);
      absent->place = absent->key_place = node_->place;
    }
    return {absent.get(), resolved};
  }
  if (!std::holds_alternative<Node::Table>(node->value))
    fail_at(node->place, fmt::format("{}: expected a table, found {}", node->path, type_name(*node)));
  return {node, resolved};
}

std::vector<Section> Section::list(std::string_view key) const {
  const Node* node = find(node_, key);
  if (node == nullptr) return {};
  const auto* items = std::get_if<Node::List>(&node->value);
  if (items == nullptr)
    fail_at(node->place, fmt::format("{}: expected an array of tables, found {}", node->path, type_name(*node)));
  auto& content = resolved_->entry(key).content;
  if (!std::holds_alternative<std::vector<std::unique_ptr<Resolved>>>(content)) {
    content = std::vector<std::unique_ptr<Resolved>>{};
    for (std::size_t i = 0; i < items->size(); ++i)
      std::get<std::vector<std::unique_ptr<Resolved>>>(content).push_back(std::make_unique<Resolved>());
  }
  std::vector<Section> out;
  for (std::size_t i = 0; i < items->size(); ++i) {
    const Node& item = (*items)[i];
    item.read = true;
    if (!std::holds_alternative<Node::Table>(item.value))
      fail_at(item.place, fmt::format("{}: expected a table, found {}", item.path, type_name(item)));
    out.push_back({&item, std::get<std::vector<std::unique_ptr<Resolved>>>(content)[i].get()});
  }
  return out;
}

template <class T>
T Section::get(std::string_view key, std::optional<T> fallback, Range range, std::string_view unit) const {
  const Node* node = find(node_, key);
  if (node == nullptr) {
    if (!fallback) {
      const std::string close = nearest(key, keys());
      fail(key, fmt::format("missing, expected {}{}{}", expected<T>(), in_unit(unit),
                            close.empty() ? "" : fmt::format("; is '{}' meant?", close)));
    }
    resolved_->entry(key).content = Value(*fallback);
    return *fallback;
  }
  const auto value = as<T>(*node);
  if (!value)
    fail_at(node->place,
            fmt::format("{}: expected {}{}, found {}", node->path, expected<T>(), in_unit(unit), type_name(*node)));
  check_range(*value, range, unit, *node);
  resolved_->entry(key).content = Value(*value);
  return *value;
}

template bool Section::get(std::string_view, std::optional<bool>, Range, std::string_view) const;
template std::int64_t Section::get(std::string_view, std::optional<std::int64_t>, Range, std::string_view) const;
template double Section::get(std::string_view, std::optional<double>, Range, std::string_view) const;
template std::string Section::get(std::string_view, std::optional<std::string>, Range, std::string_view) const;
template std::vector<double> Section::get(std::string_view, std::optional<std::vector<double>>, Range,
                                          std::string_view) const;
template std::vector<std::string> Section::get(std::string_view, std::optional<std::vector<std::string>>, Range,
                                               std::string_view) const;

std::string Section::choose(std::string_view key, std::optional<std::string> fallback,
                            const std::vector<std::string>& known) const {
  const std::string value = get<std::string>(key, std::move(fallback));
  for (const std::string& name : known)
    if (name == value) return value;
  const std::string close = nearest(value, known);
  fail(key, fmt::format("unknown value '{}', expected one of {}{}", value, join(known),
                        close.empty() ? "" : fmt::format("; is '{}' meant?", close)));
}

std::optional<double> Section::get_auto(std::string_view key, Range range, std::string_view unit) const {
  const Node* node = find(node_, key);
  const auto* text = node != nullptr ? std::get_if<std::string>(&node->value) : nullptr;
  if (node == nullptr || (text != nullptr && *text == "auto")) {
    resolved_->entry(key).content = Value(std::string("auto"));
    return {};
  }
  if (!as<double>(*node))
    fail_at(node->place,
            fmt::format("{}: expected a number{} or \"auto\", found {}", node->path, in_unit(unit), type_name(*node)));
  return get<double>(key, std::nullopt, range, unit);
}

void Section::resolve(std::string_view key, Value value) const { resolved_->entry(key).content = std::move(value); }

Case::Case() : impl_(std::make_unique<Impl>()) {}
Case::Case(Case&&) noexcept = default;
Case& Case::operator=(Case&&) noexcept = default;
Case::~Case() = default;

Case Case::from_text(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
  Case input;
  input.impl_->root = parse_toml(text, name);
  for (const std::string& assignment : overrides) apply_override(input.impl_->root, assignment);
  return input;
}

Case Case::from_file(const std::string& path, const std::vector<std::string>& overrides) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw InputError(path + ": error: is a directory, expected a case file (.toml)");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": error: cannot be opened, expected a case file (.toml)");
  std::ostringstream text;
  text << file.rdbuf();
  Case input = from_text(text.str(), path, overrides);
  input.impl_->directory = input.impl_->home = std::filesystem::path(path).parent_path().string();
  return input;
}

Section Case::root() const { return {&impl_->root, &impl_->resolved}; }
void Case::fail(const std::string& key, const std::string& what) const {
  const Node* node = &impl_->root;
  std::size_t begin = 0;
  while (begin < key.size()) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    const auto& table = table_of(node);
    const auto at = table.find(key.substr(begin, end - begin));
    if (at == table.end()) break;
    node = &at->second;
    begin = end + 1;
  }
  fail_at(node->place, key + ": " + what);
}

std::string Case::resolved() const { return to_toml(impl_->resolved); }
std::string Case::file(const Section& section, std::string_view key) const {
  namespace fs = std::filesystem;
  const fs::path file = (fs::path(impl_->directory) / section.get<std::string>(key, std::nullopt)).lexically_normal();
  const fs::path home = fs::absolute(impl_->home.empty() ? "." : impl_->home);
  section.resolve(key, fs::relative(fs::absolute(file), home).generic_string());
  return file.string();
}
void Case::will_live_in(const std::string& directory) { impl_->home = directory; }

namespace {
void reject_unread_in(const Node& node) {
  for (const auto& [key, child] : table_of(&node)) {
    if (!child.read) {
      const std::vector<std::string> known(node.asked.begin(), node.asked.end());
      const std::string close = nearest(key, known);
      std::string what = fmt::format("{}: unknown key", child.path);
      if (!close.empty())
        what += fmt::format(", is '{}' meant?", close);
      else if (!known.empty())
        what += ", expected one of " + join(known);
      fail_at(child.key_place, what);
    }
    reject_unread_in(child);
    if (const auto* list = std::get_if<Node::List>(&child.value))
      for (const Node& item : *list) reject_unread_in(item);
  }
}
}  // namespace

void Case::reject_unread() const { reject_unread_in(impl_->root); }

}  // namespace bagnold::config
