// TOML text -> Node tree. The only file that includes the TOML library.
#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cctype>

#include "config/node.hpp"

namespace bagnold::config {

void fail_at(const Place& place, const std::string& what) {
  if (place.line == 0) throw InputError(fmt::format("{}: error: {}", place.file, what));
  throw InputError(fmt::format("{}:{}:{}: error: {}", place.file, place.line, place.column, what));
}

namespace {

Place place_of(const toml::source_region& region, const std::string& name) {
  return {name, region.begin.line, region.begin.column};
}

Node convert(const toml::node& from, const std::string& path, const std::string& name) {
  Node node;
  node.place = node.key_place = place_of(from.source(), name);
  node.path = path;
  if (const auto* table = from.as_table()) {
    Node::Table children;
    for (const auto& [key, value] : *table) {
      const std::string key_text(key.str());
      Node child = convert(value, path.empty() ? key_text : path + "." + key_text, name);
      child.key_place = place_of(key.source(), name);
      children.emplace(key_text, std::move(child));
    }
    node.value = std::move(children);
  } else if (const auto* array = from.as_array()) {
    Node::List items;
    for (std::size_t i = 0; i < array->size(); ++i)
      items.push_back(convert((*array)[i], fmt::format("{}[{}]", path, i), name));
    node.value = std::move(items);
  } else if (const auto* integer = from.as_integer()) {
    node.value = integer->get();
  } else if (const auto* number = from.as_floating_point()) {
    node.value = number->get();
  } else if (const auto* boolean = from.as_boolean()) {
    node.value = boolean->get();
  } else if (const auto* text = from.as_string()) {
    node.value = text->get();
  } else {
    fail_at(node.place, fmt::format("{}: dates and times are not used here", path));
  }
  return node;
}

}  // namespace

Node parse_toml(const std::string& text, const std::string& name) {
  try {
    return convert(toml::parse(text, name), "", name);
  } catch (const toml::parse_error& error) {
    std::string what(error.description());
    fail_at(place_of(error.source(), name), what);
  }
}

void apply_override(Node& root, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const Place place{"--set " + assignment, 0, 0};
  if (equals == std::string::npos || equals == 0) fail_at(place, "expected key.path=value");
  const std::string path = assignment.substr(0, equals), text = assignment.substr(equals + 1);

  Node value;
  try {
    const toml::table parsed = toml::parse("v = " + text);
    value = convert(*parsed.get("v"), path, place.file);
  } catch (const toml::parse_error&) {
    value.value = text;  // a bare word: shells eat quotes, so take it as a string
  }
  value.place = value.key_place = place;
  value.path = path;

  Node* at = &root;
  std::size_t begin = 0;
  while (true) {
    const std::size_t dot = path.find('.', begin);
    const std::string key = path.substr(begin, dot == std::string::npos ? std::string::npos : dot - begin);
    if (key.empty()) fail_at(place, "expected key.path=value");
    auto* table = std::get_if<Node::Table>(&at->value);
    if (table == nullptr) fail_at(place, fmt::format("'{}' is not a table", at->path));
    if (dot == std::string::npos) {
      (*table)[key] = std::move(value);
      return;
    }
    Node& next = (*table)[key];
    if (next.path.empty()) {
      next.path = path.substr(0, dot);
      next.place = next.key_place = place;
    }
    at = &next;
    begin = dot + 1;
  }
}

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else
      out += c;
  }
  return out + '"';
}

std::string number_text(double v) {
  if (std::isnan(v)) return "nan";
  if (std::isinf(v)) return v > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{}", v);  // shortest text that reads back as the same bits
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string value_text(const Value& value) {
  return std::visit(
      [](const auto& v) -> std::string {
        using V = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<V, bool>)
          return v ? "true" : "false";
        else if constexpr (std::is_same_v<V, std::int64_t>)
          return fmt::format("{}", v);
        else if constexpr (std::is_same_v<V, double>)
          return number_text(v);
        else if constexpr (std::is_same_v<V, std::string>)
          return quoted(v);
        else {
          std::string out = "[";
          for (std::size_t i = 0; i < v.size(); ++i) {
            if (i > 0) out += ", ";
            if constexpr (std::is_same_v<V, std::vector<double>>)
              out += number_text(v[i]);
            else
              out += quoted(v[i]);
          }
          return out + "]";
        }
      },
      value);
}

std::string key_text(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  return bare ? key : quoted(key);
}

void print(const Resolved& table, const std::string& path, std::string& out) {
  for (const auto& e : table.entries)
    if (const auto* value = std::get_if<Value>(&e.content)) out += key_text(e.key) + " = " + value_text(*value) + "\n";
  for (const auto& e : table.entries) {
    const std::string full = path.empty() ? key_text(e.key) : path + "." + key_text(e.key);
    if (const auto* child = std::get_if<std::unique_ptr<Resolved>>(&e.content)) {
      if ((*child)->entries.empty()) continue;
      out += "\n[" + full + "]\n";
      print(**child, full, out);
    } else if (const auto* list = std::get_if<std::vector<std::unique_ptr<Resolved>>>(&e.content)) {
      for (const auto& item : *list) {
        out += "\n[[" + full + "]]\n";
        print(*item, full, out);
      }
    }
  }
}

}  // namespace

std::string to_toml(const Resolved& resolved) {
  std::string out;
  print(resolved, "", out);
  return out;
}

}  // namespace bagnold::config
