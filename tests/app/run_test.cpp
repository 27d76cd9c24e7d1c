// The program as users meet it: exit codes, errors with a place, run directories, and the same bits however a run is
// cut, threaded or observed.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/csv.hpp"
#include "io/json.hpp"
#include "support/program.hpp"
#include "support/same_state.hpp"

namespace bagnold::test {
namespace {

// A chute of about 60 grains on a flat plane: milliseconds per run, and every contact type.
const std::string tiny =
    "model = \"dem\"\nseed = 3\n"
    "[scenario]\nkind = \"chute\"\nangle_deg = 22\nlength = 5\nwidth = 4\nfill_height = 3\nbase_size_ratio = 0\n"
    "[grains]\ndiameter = 1\ndensity = 1.909859317102744\n"
    "[contact]\nnormal = \"linear\"\ncollision_time = 0.01\nrestitution = 0.8\nfriction = 0.5\n"
    "[time]\nend = 4\n";

// The same over fixed grains: no walls, so that the fast engine runs it.
const std::string rough = " --set scenario.base_size_ratio=1";

class SameBits : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Base, SameBits, testing::Values(std::string(), rough),
                         [](const auto& p) { return std::string(p.param.empty() ? "Flat" : "Rough"); });

TEST(Run, WritesADirectoryThatRunsAgainWithTheSameBits) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  const Outcome first = bagnold(scratch, "run c.toml -o a --quiet");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  for (const char* name : {"case.toml", "summary.json", "series.csv", "run.h5", "checkpoint.h5", "vtk/grains.pvd"})
    EXPECT_TRUE(fs::exists(scratch / "a" / name)) << name;
  const Outcome second = bagnold(scratch, "run a/case.toml -o b --quiet");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  expect_same_state(scratch / "a", scratch / "b");
  EXPECT_TRUE(read_text(scratch / "a" / "case.toml") == read_text(scratch / "b" / "case.toml"));
  EXPECT_TRUE(read_text(scratch / "a" / "series.csv") == read_text(scratch / "b" / "series.csv"));
  const auto summary = io::read_json(scratch / "a" / "summary.json");
  EXPECT_EQ(summary["model"], "dem");
  EXPECT_EQ(summary["scenario"], "chute");
  EXPECT_EQ(summary["status"], "completed");
  EXPECT_EQ(summary["grains"], 60);
  EXPECT_NEAR(summary["time"].get<double>(), 4, 1e-3);
}

TEST_P(SameBits, WhateverTheThreadsAndTheOutput) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  ASSERT_EQ(bagnold(scratch, "run c.toml -o one --quiet --threads 1" + GetParam()).exit_code, 0);
  ASSERT_EQ(bagnold(scratch, "run c.toml -o two --quiet --threads 2" + GetParam()).exit_code, 0);
  expect_same_state(scratch / "one", scratch / "two");
  ASSERT_EQ(bagnold(scratch,
                    "run c.toml -o busy --quiet --set output.series_every=0.01 --set output.vtk_every=0.2 "
                    "--set output.snapshot_every=0.2" +
                        GetParam())
                .exit_code,
            0);
  const auto a = io::H5File::read_only(scratch / "one" / "checkpoint.h5"),
             b = io::H5File::read_only(scratch / "busy" / "checkpoint.h5");
  for (const char* name : {"x", "v", "omega", "force"}) {
    ASSERT_TRUE(a.exists(std::string("state/dem/") + name));
    EXPECT_EQ(a.read<double>(std::string("state/dem/") + name), b.read<double>(std::string("state/dem/") + name))
        << name;
  }
}

TEST_P(SameBits, InterruptedAndResumed) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  const std::string longer = " --set time.end=25 --quiet" + GetParam();
  ASSERT_EQ(bagnold(scratch, "run c.toml -o whole" + longer).exit_code, 0);
  const Outcome cut = bagnold_cut(scratch, "run c.toml -o cut" + longer, "cut", 20);
  ASSERT_EQ(cut.exit_code, 75) << cut.err;
  EXPECT_EQ(io::read_json(scratch / "cut" / "summary.json")["status"], "interrupted");
  const Outcome rest = bagnold(scratch, "resume cut --quiet");
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  expect_same_state(scratch / "whole", scratch / "cut");
  EXPECT_TRUE(read_text(scratch / "whole" / "series.csv") == read_text(scratch / "cut" / "series.csv"));
  for (const char* name : {"profile.csv", "widths.csv", "steadiness.csv"})  // averages go on where they were
    EXPECT_TRUE(read_text(scratch / "whole" / name) == read_text(scratch / "cut" / name)) << name;
  EXPECT_TRUE(read_text(scratch / "whole" / "vtk" / "grains.pvd") == read_text(scratch / "cut" / "vtk" / "grains.pvd"));
}

TEST_P(SameBits, KilledWithoutWarningAndResumed) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  const std::string longer = " --set time.end=25 --set output.checkpoint_every_s=0.1 --quiet" + GetParam();
  ASSERT_EQ(bagnold(scratch, "run c.toml -o whole" + longer).exit_code, 0);
  (void)bagnold_cut(scratch, "run c.toml -o cut" + longer, "cut", 40, "KILL");
  const Outcome rest = bagnold(scratch, "resume cut --quiet");
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  expect_same_state(scratch / "whole", scratch / "cut");
  EXPECT_TRUE(read_text(scratch / "whole" / "series.csv") == read_text(scratch / "cut" / "series.csv"));
}

// What is due half a millionth of a step after a step is due at the next one; the run must not wait for it on the spot.
TEST(Run, GoesOnWhereARowIsDueAHairAfterAStep) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  const Outcome r = bagnold(
      scratch,
      "run c.toml -o a --quiet --set time.end=0.5 --set time.step=1e-4 --set output.series_every=0.10000000005");
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const auto series = io::read_csv(scratch / "a" / "series.csv");
  ASSERT_EQ(series.rows(), 6u);
  EXPECT_NEAR(series["t"][1], 0.1001, 1e-9);
}

TEST(Run, NeverReplacesWhatIsThere) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  ASSERT_EQ(bagnold(scratch, "run c.toml -o a --quiet --set time.end=0.1").exit_code, 0);
  const Outcome again = bagnold(scratch, "run c.toml -o a --quiet --set time.end=0.1");
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.err.find("holds a run already"), std::string::npos) << again.err;
  EXPECT_EQ(bagnold(scratch, "run c.toml -o a --quiet --overwrite --set time.end=0.1").exit_code, 0);
  fs::create_directories(scratch / "precious");
  write_text(scratch / "precious" / "thesis.tex", "x");
  EXPECT_EQ(bagnold(scratch, "run c.toml -o precious --overwrite --quiet").exit_code, 2);
  EXPECT_EQ(read_text(scratch / "precious" / "thesis.tex"), "x");
  // A case that turns out to be wrong must not cost the run that is there.
  EXPECT_EQ(bagnold(scratch, "run c.toml -o a --overwrite --quiet --set contact.frictoin=1").exit_code, 2);
  EXPECT_TRUE(fs::exists(scratch / "a" / "summary.json"));
}

struct BadInput {
  const char* set;       // override that makes the tiny case wrong
  const char* expected;  // what the error must say
};
class Rejects : public testing::TestWithParam<BadInput> {};

TEST_P(Rejects, WithExitCode2AndAPlace) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  const Outcome outcome = bagnold(scratch, std::string("run c.toml -o a --quiet --set '") + GetParam().set + "'");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("error: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(GetParam().expected), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(scratch / "a"));
}

INSTANTIATE_TEST_SUITE_P(
    Input, Rejects,
    testing::Values(BadInput{"contact.frictoin=0.5", "is 'friction' meant?"},
                    BadInput{"scenario.kind=\"shute\"", "is 'chute' meant?"},
                    BadInput{"contact.normal=\"hertzian\"", "is 'hertz' meant?"},
                    BadInput{"model=\"den\"", "is 'dem' meant?"}, BadInput{"contact.collision_time=-1", "expected > 0"},
                    BadInput{"contact.restitution=1.2", "out of range"},
                    BadInput{"contact.friction=-0.1", "expected >= 0"},
                    BadInput{"contact.stiffness=2e5", "either both of stiffness and damping"},
                    BadInput{"scenario.angle_deg=95", "out of range"},
                    BadInput{"scenario.fill_height=0", "expected > 0"},
                    BadInput{"scenario.fill_height=1e-3", "no grains"},
                    BadInput{"scenario.length=0.5", "scenario.length"}, BadInput{"time.step=0.005", "time.step"},
                    BadInput{"time.step=0", "expected > 0"}, BadInput{"time.end=\"soon\"", "expected a number"},
                    BadInput{"grains.density=-2", "expected > 0"}, BadInput{"seed=1.5", "expected an integer"}));

TEST(Run, AsksForTheConventionOfTheDamping) {
  const Scratch scratch;
  std::string text = tiny;
  text.replace(text.find("collision_time = 0.01\nrestitution = 0.8"), 39, "stiffness = 5e4\ndamping = 20");
  write_text(scratch / "c.toml", text);
  const Outcome outcome = bagnold(scratch, "run c.toml -o a --quiet");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("c.toml:16:11: error: contact.damping: damping_convention is missing"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(
      bagnold(scratch, "run c.toml -o a --quiet --set contact.damping_convention=force --set time.end=0.1").exit_code,
      0);
}

TEST(Run, PrintsTheCollisionTimeOfEveryContactType) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  const Outcome outcome = bagnold(scratch, "run c.toml -o a --set time.end=0.1");
  for (const char* word : {"contact grain-grain", "contact grain-base", "collision time", "restitution"})
    EXPECT_NE(outcome.err.find(word), std::string::npos) << word << "\n" << outcome.err;
}

TEST(Run, CatchesOverlapsAtTheStart) {
  const Scratch scratch;
  const auto pair_at = [&](double distance) {
    write_text(scratch / "c.toml",
               "model = \"dem\"\n[scenario]\nkind = \"grains\"\n"
               "[[scenario.grains]]\nposition = [0, 0, 0]\n[[scenario.grains]]\nposition = [" +
                   std::to_string(distance) +
                   ", 0, 0]\n"
                   "[contact]\nstiffness = 2e5\ndamping = 25\ndamping_convention = \"force\"\n[time]\nend = 0.01\n");
    return bagnold(scratch, "run c.toml -o a --quiet --overwrite");
  };
  for (const double distance : {0.9, 0.3, 0.0}) {
    const Outcome outcome = pair_at(distance);
    EXPECT_EQ(outcome.exit_code, 2) << distance << outcome.err;
    EXPECT_NE(outcome.err.find("overlap"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.rfind("c.toml:2", 0), 0u) << outcome.err;
  }
  const Outcome slight = pair_at(0.98);
  EXPECT_EQ(slight.exit_code, 0);
  EXPECT_NE(slight.err.find("warning: scenario: grains overlap"), std::string::npos) << slight.err;
}

TEST(Run, SaysWhereInTheFile) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny + "ned = 5\n");
  const Outcome outcome = bagnold(scratch, "run c.toml -o a");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err.rfind("c.toml:20:1: error: time.ned: unknown key, is 'end' meant?", 0), 0u) << outcome.err;
}

TEST(Run, UsageErrorsAreExitCode2) {
  const Scratch scratch;
  EXPECT_EQ(bagnold(scratch, "").exit_code, 2);
  EXPECT_EQ(bagnold(scratch, "rnu").exit_code, 2);
  EXPECT_EQ(bagnold(scratch, "run missing.toml").exit_code, 2);
  EXPECT_EQ(bagnold(scratch, "resume nowhere").exit_code, 2);
  EXPECT_EQ(bagnold(scratch, "--help").exit_code, 0);
  EXPECT_EQ(bagnold(scratch, "--version").exit_code, 0);
}

TEST(Run, UnwritableDirectoryIsExitCode4) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  EXPECT_EQ(bagnold(scratch, "run c.toml -o /proc/nowhere --quiet").exit_code, 4);
}

TEST(Check, PrintsWhatFollowsFromTheInputAndTakesNoStep) {
  const Scratch scratch;
  write_text(scratch / "c.toml", tiny);
  const Outcome outcome = bagnold(scratch, "check c.toml");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* word : {"collision time", "restitution", "time step", "grains", "disk", "memory"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << "\n" << outcome.out;
  EXPECT_EQ(bagnold(scratch, "check c.toml --set time.ned=1").exit_code, 2);
}

TEST(Explain, KnowsEveryTopicItLists) {
  const Scratch scratch;
  const Outcome all = bagnold(scratch, "explain");
  ASSERT_EQ(all.exit_code, 0);
  for (const char* topic : {"linear", "hertz", "mindlin", "spring_slider", "chute", "column", "output", "time",
                            "inclined_plane", "numerics"}) {
    EXPECT_NE(all.out.find(topic), std::string::npos) << topic;
    const Outcome one = bagnold(scratch, std::string("explain ") + topic);
    EXPECT_EQ(one.exit_code, 0) << topic;
    EXPECT_NE(one.out.find(topic), std::string::npos);
  }
  EXPECT_NE(bagnold(scratch, "explain time").out.find("stop_when_arrested"), std::string::npos);
  EXPECT_NE(bagnold(scratch, "explain column").out.find("disorder"), std::string::npos);
  const Outcome wrong = bagnold(scratch, "explain lineer");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("is 'linear' meant?"), std::string::npos) << wrong.err;
}

}  // namespace
}  // namespace bagnold::test
