#include "house.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace bagnold::architecture {
namespace {

const std::filesystem::path root = BAGNOLD_SOURCE_DIR;
const std::set<std::string> cpp{".hpp", ".cpp"};

std::string text_of(const std::string& path) {
  std::ifstream in(root / path);
  return {std::istreambuf_iterator<char>(in), {}};
}

const std::vector<SourceFile>& sources() {
  static const auto files = files_below(root, "src", cpp);
  return files;
}

bool any_include(const SourceFile& file, const std::set<std::string>& names) {
  const auto found = includes(file);
  return std::any_of(found.begin(), found.end(), [&](const auto& name) { return names.contains(name); });
}

// The files of src/ that include one of `names`.
std::vector<std::string> users_of(const std::set<std::string>& names) {
  std::vector<std::string> users;
  for (const auto& file : sources())
    if (any_include(file, names)) users.push_back(file.path);
  return users;
}

TEST(Rules, TheGraphIsReadFromCMakeAndFollowsDependencies) {
  const auto graph = module_graph(
      "bagnold_module(core DEPENDS fmt::fmt)\nbagnold_module(io   DEPENDS core)\n# words\nbagnold_module(dem "
      "DEPENDS core)\n"
      "bagnold_module(app DEPENDS io\n dem)\n");
  using Set = std::set<std::string>;
  EXPECT_EQ(graph.at("core"), Set{"core"});
  EXPECT_EQ(graph.at("io"), (Set{"core", "io"}));
  EXPECT_EQ(graph.at("app"), (Set{"app", "core", "dem", "io"}));
}

TEST(Rules, AnIncludeAgainstTheGraphIsFound) {
  const auto graph =
      module_graph("bagnold_module(core)\nbagnold_module(io DEPENDS core)\nbagnold_module(dem DEPENDS core)\n");
  const SourceFile engine{"src/dem/state.cpp",
                          "#include \"core/box.hpp\"\n  # include <io/csv.hpp> // why\n#include <vector>\n"};
  ASSERT_EQ(wrong_includes(engine, graph).size(), 1u);
  EXPECT_EQ(wrong_includes(engine, graph)[0], "src/dem/state.cpp includes io/csv.hpp: dem does not depend on io");
  EXPECT_EQ(wrong_includes({"src/core/box.hpp", "#include \"dem/state.hpp\"\n"}, graph).size(), 1u);
  EXPECT_TRUE(wrong_includes({"src/dem/b.cpp", "#include \"dem/a.hpp\"\n// #include \"io/csv.hpp\"\n"}, graph).empty());
}

TEST(House, EveryFolderIsAModule) {
  const auto graph = module_graph(text_of("CMakeLists.txt"));
  ASSERT_GT(sources().size(), 20u);
  for (const auto& file : sources()) {
    const auto module = module_of(file.path);
    EXPECT_TRUE(module.empty() || graph.contains(module)) << file.path;
  }
}

TEST(House, IncludesFollowTheModuleGraph) {
  const auto graph = module_graph(text_of("CMakeLists.txt"));
  for (const auto& file : sources())
    for (const auto& wrong : wrong_includes(file, graph)) ADD_FAILURE() << wrong;
}

TEST(House, EnginesDoNotKnowEachOtherNorFilesNorCases) {
  const auto graph = module_graph(text_of("CMakeLists.txt"));
  for (const char* engine : {"laws", "neighbours", "dem", "sph", "shallow", "closure", "cg", "scenario"})
    for (const char* outer : {"io", "config", "report", "app"})
      EXPECT_FALSE(graph.at(engine).contains(outer)) << engine;
  for (const char* engine : {"dem", "sph", "shallow"})
    for (const char* other : {"dem", "sph", "shallow"})
      EXPECT_EQ(graph.at(engine).contains(other), std::string(engine) == other) << engine << " -> " << other;
}

TEST(House, EnginesNeverWrite) {
  const std::set<std::string> engines{"core",    "laws",    "neighbours", "dem",     "sph",
                                      "shallow", "closure", "cg",         "scenario"};
  for (const auto& file : sources()) {
    if (!engines.contains(module_of(file.path))) continue;
    if (file.path.ends_with("core/cpu_limit.cpp")) continue;  // reads what the system allows this process
    EXPECT_FALSE(
        any_include(file, {"fstream", "iostream", "cstdio", "stdio.h", "filesystem", "fmt/os.h", "fmt/ostream.h"}))
        << file.path;
    for (const char* call : {"printf(", "fmt::print(", "std::cout", "std::cerr"})
      EXPECT_EQ(file.text.find(call), std::string::npos) << file.path << " uses " << call;
  }
}

TEST(House, HeavyLibrariesHaveOneDoor) {
  for (const auto& user : users_of({"toml++/toml.h", "toml++/toml.hpp", "toml.hpp"}))
    EXPECT_EQ(module_of(user), "config") << user;
  for (const auto& user : users_of({"hdf5.h"})) EXPECT_EQ(user, "src/io/hdf5.cpp");
  EXPECT_FALSE(users_of({"hdf5.h"}).empty());
  EXPECT_LE(users_of({"gdal.h", "gdal_priv.h", "gdal/gdal.h", "gdal/gdal_priv.h"}).size(), 1u);
  for (const auto& user : users_of({"CLI/CLI.hpp"})) EXPECT_EQ(module_of(user), "app") << user;
}

TEST(House, FilesFitInAHead) {
  for (const auto& file : sources()) EXPECT_LE(std::count(file.text.begin(), file.text.end(), '\n'), 450) << file.path;
}

TEST(House, HeadersAreIncludedOnce) {
  for (const auto& file : files_below(root, "src", {".hpp"}))
    EXPECT_NE(file.text.find("#pragma once"), std::string::npos) << file.path;
}

TEST(House, NothingIsLeftForLater) {
  for (const auto& folder : {"src", "tests", "bench"})
    for (const auto& file : files_below(root, folder, cpp)) {
      if (file.path == "tests/architecture/house_test.cpp") continue;
      for (const char* mark : {"TODO", "FIXME"})
        EXPECT_EQ(file.text.find(mark), std::string::npos) << file.path << " says " << mark;
    }
}

TEST(House, EveryCaseIsTested) {
  std::string tests;
  for (const auto& file : files_below(root, "tests/cases", cpp)) tests += file.text;
  for (const auto& file : files_below(root, "cases", {".toml"})) {
    const auto name = std::filesystem::path(file.path).filename().string();
    EXPECT_NE(tests.find(name), std::string::npos) << file.path << " is not mentioned in tests/cases";
  }
}

// Reproducible results: no flag or pragma that lets the compiler reorder floating-point sums.
TEST(House, NoFastMath) {
  auto build_files = files_below(root, "cmake", {".cmake"});
  for (const char* name : {"CMakeLists.txt", "CMakePresets.json", "Makefile", "tests/CMakeLists.txt"})
    build_files.push_back({name, text_of(name)});
  for (const auto& file : sources()) build_files.push_back(file);
  for (const auto& file : files_below(root, "src", {".cmake"})) build_files.push_back(file);
  for (auto file : build_files) {
    for (std::size_t at = 0; (at = file.text.find("No -ffast-math", at)) != std::string::npos;) file.text.erase(at, 14);
    for (const char* flag : {"fast-math", "-Ofast", "associative-math", "reciprocal-math", "finite-math-only"})
      EXPECT_EQ(file.text.find(flag), std::string::npos) << file.path << " says " << flag;
  }
}

}  // namespace
}  // namespace bagnold::architecture
