// Estimates of what a run takes: from the last runs here, else from a stated default.
#include "app/cost.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "app/machine.hpp"
#include "core/parallel.hpp"
#include "io/json.hpp"
#include "support/program.hpp"

namespace bagnold::test {
namespace {

class Costs : public testing::Test {
 protected:
  Costs() {
    before_ = std::getenv("XDG_CACHE_HOME") != nullptr ? std::getenv("XDG_CACHE_HOME") : "";
    setenv("XDG_CACHE_HOME", (scratch / "cache").c_str(), 1);
  }
  ~Costs() override { setenv("XDG_CACHE_HOME", before_.c_str(), 1); }
  Scratch scratch;
  std::string before_;
  // An hour at a million a second.
  const app::Cost cost{
      .elements = "grain", .engine = "fast", .count = 3000, .element_steps = 3.6e9 * threads(), .usual_speed = 1e6};
};

TEST_F(Costs, AreAssumedUntilARunHasShownItsSpeed) {
  EXPECT_EQ(app::time_text(cost, "dem").rfind("about 1 h 00 min", 0), 0U) << app::time_text(cost, "dem");
  EXPECT_NE(app::time_text(cost, "dem").find("assumed"), std::string::npos);
  app::remember_speed(cost, "dem", 1e9, 1.5);  // too short to say anything
  EXPECT_NE(app::time_text(cost, "dem").find("assumed"), std::string::npos);
  app::remember_speed(cost, "dem", 6e8 * threads(), 10);
  EXPECT_EQ(app::time_text(cost, "dem").rfind("about 1 min 00 s", 0), 0U) << app::time_text(cost, "dem");
  EXPECT_NE(app::time_text(cost, "dem").find("as lately here"), std::string::npos);
}

TEST_F(Costs, OfAnotherModelEngineOrSizeAreNotTakenForThis) {
  app::remember_speed(cost, "dem", 6e8, 10);
  EXPECT_NE(app::time_text(cost, "sph").find("assumed"), std::string::npos);
  app::Cost other = cost;
  other.engine = "plain";
  EXPECT_NE(app::time_text(other, "dem").find("assumed"), std::string::npos);
  other = cost;
  other.count = 10000;  // near enough
  EXPECT_NE(app::time_text(other, "dem").find("as lately here"), std::string::npos);
  other.count = 100000;
  EXPECT_NE(app::time_text(other, "dem").find("assumed"), std::string::npos);
}

TEST_F(Costs, SurviveAFileThatIsNone) {
  fs::create_directories(scratch / "cache" / "bagnold");
  for (const char* text : {"", "not json", "[1, 2]", "{\"dem fast avx2\": 3}"}) {
    write_text(scratch / "cache" / "bagnold" / "speeds.json", text);
    EXPECT_NE(app::time_text(cost, "dem").find("assumed"), std::string::npos) << text;
    app::remember_speed(cost, "dem", 6e8 * threads(), 10);
    EXPECT_NE(app::time_text(cost, "dem").find("as lately here"), std::string::npos) << text;
  }
}

TEST_F(Costs, SayWhenNobodyCanTell) {
  app::Cost never = cost;
  never.element_steps = NAN;
  EXPECT_NE(app::time_text(never, "shallow").find("unknown"), std::string::npos);
}

TEST_F(Costs, CountEveryFileThatIsAskedFor) {
  app::Cost heavy = cost;
  heavy.snapshot_mb = 10;
  heavy.vtk_mb = 1;
  const auto lines = app::cost_lines(heavy, "dem", {.series_every = 1, .snapshot_every = 10, .vtk_every = 1}, 100);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[2].name, "disk");
  EXPECT_NEAR(std::stod(lines[2].value), 12 * 10 + 102, 1);  // at t = 0, 10, ..., 100 and at the end
}

TEST(Machine, CountsTheTimeOfItsProcessor) {
  const double before = app::cpu_seconds();
  volatile double sum = 0;
  while (app::cpu_seconds() < before + 0.05) sum = sum + 1;
  EXPECT_GT(app::cpu_seconds(), before);
}

}  // namespace
}  // namespace bagnold::test
