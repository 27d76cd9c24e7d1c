// Settled beds as users meet them: stored under what made them, refused when they are foreign, carried by the run; and
// nothing that can be told without them settles one.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/bed_store.hpp"
#include "io/hdf5.hpp"
#include "io/json.hpp"
#include "support/program.hpp"
#include "support/same_state.hpp"

namespace bagnold::test {
namespace {

// A chute as narrow as can be, over a base cut from a bed of some fifty grains: settled in a second.
const std::string narrow =
    "model = \"dem\"\nseed = 3\n"
    "[scenario]\nkind = \"chute\"\nangle_deg = 22\nlength = 2.2\nwidth = 2\nfill_height = 3\n"
    "[contact]\ncollision_time = 0.01\nrestitution = 0.8\n"
    "[time]\nend = 0.5\n";

class Beds : public testing::Test {
 protected:
  Beds() { write_text(scratch / "c.toml", narrow); }
  // In a cache of its own, empty at first.
  Outcome run(const std::string& arguments, const std::string& cache = "cache") {
    return bagnold(scratch, arguments, "XDG_CACHE_HOME='" + (scratch / cache).string() + "'");
  }
  static bool settled(const Outcome& outcome) { return outcome.err.find("settling a bed") != std::string::npos; }
  std::vector<fs::path> files(const std::string& cache = "cache") const {
    std::vector<fs::path> found;
    if (fs::exists(scratch / cache / "bagnold"))
      for (const auto& entry : fs::directory_iterator(scratch / cache / "bagnold"))
        if (entry.path().filename().string().rfind("bed", 0) == 0) found.push_back(entry.path());
    return found;
  }
  std::string hash_of(const std::string& run_directory) const {
    return io::read_json(scratch / run_directory / "summary.json")["bed_hash"];
  }
  Scratch scratch;
};

TEST_F(Beds, AreSettledOnceAndKeptWithTheRun) {
  const Outcome first = run("run c.toml -o a");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(settled(first));
  const Outcome second = run("run c.toml -o b");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_FALSE(settled(second));
  expect_same_state(scratch / "a", scratch / "b");
  ASSERT_EQ(files().size(), 1U);
  const auto beds = app::read_beds(scratch / "a" / "run.h5"), cached = app::read_beds(files()[0]);
  ASSERT_EQ(beds.size(), 1U);
  EXPECT_EQ(beds[0].hash, hash_of("a"));
  EXPECT_EQ(beds[0].hash, app::bed_hash(beds[0].bed));
  EXPECT_EQ(beds[0].path, scenario::bed_path());
  EXPECT_TRUE(beds[0].recipe == cached[0].recipe);
  EXPECT_EQ(beds[0].bed.x, cached[0].bed.x);
  EXPECT_NE(read_text(scratch / "a" / "case.toml").find("bed_hash = \"" + beds[0].hash), std::string::npos);
  // Elsewhere the same bed comes about.
  ASSERT_EQ(run("run a/case.toml -o c --quiet", "elsewhere").exit_code, 0);
  expect_same_state(scratch / "a", scratch / "c");
}

// What somebody, or another program, may have left in the cache under the name of the bed.
struct Foreign {
  const char* name;
  void (*put)(const fs::path& bed, const fs::path& other);
  const char* why;
};
class ForeignBeds : public Beds, public testing::WithParamInterface<Foreign> {};

void change(const fs::path& path, void (*how)(app::StoredBed&)) {
  app::StoredBed stored = app::read_beds(path)[0];
  how(stored);
  auto file = io::H5File::create(path);
  app::write_bed(file, "bed", stored);
  file.close();
}

INSTANTIATE_TEST_SUITE_P(
    Cache, ForeignBeds,
    testing::Values(Foreign{"OfAnotherRecipe",
                            [](const fs::path& bed, const fs::path& other) {
                              fs::copy_file(other, bed, fs::copy_options::overwrite_existing);
                            },
                            "it was made with seed = 4, wanted 3"},
                    Foreign{"WithAMovedGrain",
                            [](const fs::path& bed, const fs::path&) {
                              change(bed, [](app::StoredBed& b) { b.bed.x[5].z += 1e-12; });
                            },
                            "its arrays have the hash"},
                    Foreign{"FromAnotherPath",
                            [](const fs::path& bed, const fs::path&) {
                              change(bed, [](app::StoredBed& b) {
                                b.path = "settle_bed 1, fused";
                                b.bed.x[5].z += 1e-12;
                                b.hash = app::bed_hash(b.bed);  // a good bed, of somebody else
                              });
                            },
                            "it was made by \"settle_bed 1, fused\""},
                    Foreign{"OfAnotherFormat",
                            [](const fs::path& bed, const fs::path&) {
                              auto file = io::H5File::append(bed);
                              file.attribute("beds/bed", "format", 0);
                              file.close();
                            },
                            "a bed of format 0"},
                    Foreign{"NoBedAtAll", [](const fs::path& bed, const fs::path&) { write_text(bed, "not a bed"); },
                            "not a readable HDF5 file"}),
    [](const auto& p) { return std::string(p.param.name); });

TEST_P(ForeignBeds, AreRefusedAndReplaced) {
  ASSERT_EQ(run("run c.toml -o a --quiet").exit_code, 0);
  const fs::path bed = files()[0];
  ASSERT_EQ(run("run c.toml -o of-seed-4 --quiet --set seed=4", "other").exit_code, 0);
  GetParam().put(bed, files("other")[0]);
  const Outcome again = run("run c.toml -o b");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.err.find("warning: " + bed.string() + ": not used: "), std::string::npos) << again.err;
  EXPECT_NE(again.err.find(GetParam().why), std::string::npos) << again.err;
  EXPECT_TRUE(settled(again));
  expect_same_state(scratch / "a", scratch / "b");
  EXPECT_EQ(hash_of("a"), hash_of("b"));
  const Outcome quiet = run("run c.toml -o c");  // the bed has been replaced
  EXPECT_EQ(quiet.err.find("warning"), std::string::npos) << quiet.err;
  EXPECT_FALSE(settled(quiet));
}

TEST_F(Beds, OfARunRepeatItElsewhere) {
  ASSERT_EQ(run("run c.toml -o a --quiet").exit_code, 0);
  // Another bed of the same recipe, as another program might have made it; the run on it carries it.
  fs::copy_file(files()[0], scratch / "mine.h5");
  change(scratch / "mine.h5", [](app::StoredBed& b) {
    for (Vec3& x : b.bed.x) x.x += 1e-3;
    b.hash = app::bed_hash(b.bed);
    b.path = "by hand";
  });
  ASSERT_EQ(run("run c.toml -o mine --quiet --set scenario.bed=mine.h5").exit_code, 0);
  EXPECT_NE(hash_of("mine"), hash_of("a"));
  const Outcome repeated = run("run c.toml -o again --set scenario.bed=mine/run.h5", "elsewhere");
  ASSERT_EQ(repeated.exit_code, 0) << repeated.err;
  EXPECT_FALSE(settled(repeated));
  expect_same_state(scratch / "mine", scratch / "again");
  // Its case, without the bed: a different one is found out.
  const Outcome different = run("run mine/case.toml -o c --quiet --set scenario.bed=auto");
  EXPECT_EQ(different.exit_code, 2);
  EXPECT_NE(different.err.find(hash_of("mine")), std::string::npos) << different.err;
  EXPECT_NE(different.err.find(hash_of("a")), std::string::npos) << different.err;
  EXPECT_NE(different.err.find("scenario.bed_hash"), std::string::npos) << different.err;
  EXPECT_FALSE(fs::exists(scratch / "c"));
  const std::string any = " --set scenario.bed=auto --set scenario.bed_hash=auto";
  EXPECT_EQ(run("run mine/case.toml -o c --quiet" + any).exit_code, 0);
  // Of another recipe, or nothing that could hold a bed.
  const Outcome other = run("run c.toml -o d --quiet --set seed=4 --set scenario.bed=a/run.h5");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("it holds no bed made with the numbers"), std::string::npos) << other.err;
  EXPECT_EQ(run("run c.toml -o d --quiet --set scenario.bed=c.toml").exit_code, 2);
  EXPECT_EQ(run("run c.toml -o d --quiet --set scenario.base_size_ratio=0 --set scenario.bed=a/run.h5").exit_code, 2);
}

TEST_F(Beds, AreNotSettledForACheck) {
  const Outcome outcome = run("check c.toml");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("about"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("not settled yet; the first time about"), std::string::npos) << outcome.out;
  EXPECT_FALSE(settled(outcome));
  EXPECT_FALSE(fs::exists(scratch / "cache"));
  ASSERT_EQ(run("run c.toml -o a --quiet").exit_code, 0);
  const Outcome after = run("check c.toml");
  EXPECT_NE(after.out.find(hash_of("a").substr(0, 16)), std::string::npos) << after.out;
  EXPECT_EQ(after.out.find("not settled yet"), std::string::npos) << after.out;
}

TEST_F(Beds, AreNotSettledForWhatIsRefused) {
  fs::create_directories(scratch / "taken");
  write_text(scratch / "taken" / "thesis.tex", "x");
  for (const char* wrong : {"-o a --set contact.frictoin=1", "-o a --set output.nothing=1", "-o a --set time.step=0.01",
                            "-o a --set cg.from=2 --set cg.until=1", "-o a --set contact.stiffness=2e5",
                            "-o a --set cg.kernel=round", "-o taken", "-o a --set scenario.length=1.5"}) {
    const Outcome outcome = run(std::string("run c.toml --quiet ") + wrong);
    EXPECT_EQ(outcome.exit_code, 2) << wrong << outcome.err;
    EXPECT_FALSE(fs::exists(scratch / "cache")) << wrong;
    EXPECT_FALSE(fs::exists(scratch / "a")) << wrong;
  }
}

TEST_F(Beds, CanBeInterruptedWhileTheySettle) {
  const std::string cache = " XDG_CACHE_HOME='" + (scratch / "cache").string() + "'";
  for (const char* signal : {"TERM", "INT"}) {
    const std::string err = (scratch / "stderr.txt").string();
    const Outcome outcome =
        bagnold(scratch,
                "run c.toml -o a --set scenario.width=12 --set scenario.length=12 >stdout.txt 2>stderr.txt & pid=$!; "
                "while kill -0 $pid && ! grep -q settling " +
                    err + "; do sleep 0.02; done 2>/dev/null; kill -" + signal + " $pid; wait $pid; exit $? #",
                cache);
    EXPECT_EQ(outcome.exit_code, 75) << outcome.err;
    EXPECT_NE(outcome.err.find("no run was begun"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(scratch / "a"));
    EXPECT_TRUE(files().empty());
  }
}

TEST_F(Beds, AreNotNeededToResume) {
  const Outcome cut = bagnold_cut(scratch, "run c.toml -o a --quiet --set time.end=20", "a", 20);
  ASSERT_EQ(cut.exit_code, 75) << cut.err;
  const Outcome rest = run("resume a", "nothing");
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_FALSE(settled(rest));
  EXPECT_FALSE(fs::exists(scratch / "nothing" / "bagnold" / "bed"));
  const auto summary = io::read_json(scratch / "a" / "summary.json");
  EXPECT_EQ(summary["status"], "completed");
  EXPECT_EQ(summary["bed_hash"].get<std::string>().size(), 64U);
}

TEST_F(Beds, MayBeSettledByTwoAtOnce) {
  const std::string here = scratch.path().string();
  const Outcome both = run("run c.toml -o a --quiet & cd '" + here + "' && XDG_CACHE_HOME='" + here +
                           "/cache' '" BAGNOLD_PROGRAM "' run c.toml -o b --quiet; other=$?; wait $! && exit $other #");
  ASSERT_EQ(both.exit_code, 0) << both.err;
  expect_same_state(scratch / "a", scratch / "b");
  ASSERT_EQ(files().size(), 1U);
  EXPECT_EQ(app::read_beds(files()[0])[0].hash, hash_of("a"));
}

}  // namespace
}  // namespace bagnold::test
