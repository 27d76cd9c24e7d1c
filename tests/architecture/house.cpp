#include "house.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace bagnold::architecture {

std::map<std::string, std::set<std::string>> module_graph(const std::string& cmake) {
  std::map<std::string, std::set<std::string>> direct;
  const std::regex line(R"(bagnold_module\((\w+)(?:\s+DEPENDS\s+([^)]*))?\))");
  for (std::sregex_iterator it(cmake.begin(), cmake.end(), line), end; it != end; ++it) {
    auto& dependencies = direct[(*it)[1]];
    std::istringstream words((*it)[2].str());
    for (std::string word; words >> word;)
      if (word.find("::") == std::string::npos) dependencies.insert(word);  // the others are libraries
  }
  auto reachable = direct;
  for (bool grew = true; grew;) {
    grew = false;
    for (auto& [module, reached] : reachable) {
      const auto before = reached.size();
      for (const auto& next : std::set(reached)) reached.insert(direct[next].begin(), direct[next].end());
      grew = grew || reached.size() > before;
    }
  }
  for (auto& [module, reached] : reachable) reached.insert(module);
  return reachable;
}

std::string module_of(const std::string& path) {
  if (!path.starts_with("src/")) return "";
  const auto end = path.find('/', 4);
  return end == std::string::npos ? "" : path.substr(4, end - 4);
}

std::vector<std::string> includes(const SourceFile& file) {
  std::vector<std::string> names;
  std::istringstream lines(file.text);
  const std::regex include(R"(^\s*#\s*include\s*["<]([^">]+)[">].*)");
  std::smatch match;
  for (std::string line; std::getline(lines, line);)
    if (std::regex_match(line, match, include)) names.push_back(match[1]);
  return names;
}

std::vector<std::string> wrong_includes(const SourceFile& file,
                                        const std::map<std::string, std::set<std::string>>& graph) {
  std::vector<std::string> wrong;
  const auto self = graph.find(module_of(file.path));
  for (const auto& name : includes(file)) {
    const auto target = name.substr(0, name.find('/'));
    if (target == name || !graph.contains(target)) continue;  // a library
    if (self != graph.end() && !self->second.contains(target))
      wrong.push_back(file.path + " includes " + name + ": " + self->first + " does not depend on " + target);
  }
  return wrong;
}

std::vector<SourceFile> files_below(const std::filesystem::path& root, const std::string& folder,
                                    const std::set<std::string>& extensions) {
  std::vector<SourceFile> files;
  if (!std::filesystem::exists(root / folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
    if (!entry.is_regular_file() || !extensions.contains(entry.path().extension())) continue;
    std::ifstream in(entry.path());
    files.push_back({std::filesystem::relative(entry.path(), root), {std::istreambuf_iterator<char>(in), {}}});
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

}  // namespace bagnold::architecture
