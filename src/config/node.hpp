// The case as read: our own tree of values with their places, so that only parse.cpp knows the TOML library.
#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "config/case.hpp"

namespace bagnold::config {

struct Place {
  std::string file;  // or "--set key=value"
  unsigned line = 0, column = 0;
};

struct Node {
  Node() = default;
  Node(Node&&) = default;
  Node& operator=(Node&&) = default;
  using Table = std::map<std::string, Node>;
  using List = std::vector<Node>;
  std::variant<bool, std::int64_t, double, std::string, List, Table> value = Table{};
  Place place, key_place;                                       // of the value; of its key
  std::string path;                                             // "scenario.angle_deg"
  mutable bool read = false;                                    // somebody asked for it
  mutable std::set<std::string> asked;                          // of a table: every key asked for, present or not
  mutable std::map<std::string, std::unique_ptr<Node>> absent;  // child tables asked for that are not there
};

// The same shape, holding what the run actually used, in the order it was asked for.
struct Resolved {
  struct Entry {
    std::string key;
    std::variant<Value, std::unique_ptr<Resolved>, std::vector<std::unique_ptr<Resolved>>> content;
  };
  std::vector<Entry> entries;
  Entry& entry(std::string_view key);
};

// Throws InputError at the place of a syntax error.
Node parse_toml(const std::string& text, const std::string& name);
// Applies one `key.path=value` override.
void apply_override(Node& root, const std::string& assignment);
std::string to_toml(const Resolved& resolved);
[[noreturn]] void fail_at(const Place& place, const std::string& what);

}  // namespace bagnold::config
