// The rules of the house as functions of text, so that the rules themselves can be tested.
#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace bagnold::architecture {

struct SourceFile {
  std::string path;  // relative to the repository, "src/io/csv.cpp"
  std::string text;
};

// Module -> every module it may include, itself and what its dependencies depend on included. Read from the
// bagnold_module(NAME DEPENDS ...) lines of a CMakeLists.txt.
std::map<std::string, std::set<std::string>> module_graph(const std::string& cmake);

std::string module_of(const std::string& path);  // "io" of "src/io/csv.cpp"; "" of "src/main.cpp"

// What is between the quotes or brackets of the #include lines.
std::vector<std::string> includes(const SourceFile& file);

// One line of text per include that goes against the graph.
std::vector<std::string> wrong_includes(const SourceFile& file,
                                        const std::map<std::string, std::set<std::string>>& graph);

// Files below `folder` of the repository whose extension is one of `extensions`, sorted by path.
std::vector<SourceFile> files_below(const std::filesystem::path& root, const std::string& folder,
                                    const std::set<std::string>& extensions);

}  // namespace bagnold::architecture
