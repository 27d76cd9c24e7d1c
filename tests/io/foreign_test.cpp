// Dumps of other programs: what is read, and that what is not a dump is refused with its line.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/lammps.hpp"
#include "io/mercury.hpp"
#include "scratch.hpp"

namespace bagnold::io {
namespace {

constexpr const char* atoms =
    "ITEM: UNITS\nlj\nITEM: TIME\n0.5\nITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff fs\n-1 "
    "1\n0 2.5\n0 1e1\n"
    "ITEM: ATOMS id x\n7 0.25\n3 -1e-3\n";

TEST(Lammps, ReadsInstantsColumnsAndBounds) {
  const Scratch scratch;
  write_file(scratch / "a.dump", std::string(atoms) + atoms);
  LammpsDump dump(scratch / "a.dump");
  const auto frame = dump.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->step, 100);
  EXPECT_EQ(frame->time, 0.5);
  EXPECT_EQ(frame->hi, (Vec3{1, 2.5, 10}));
  EXPECT_EQ(frame->periodic, (std::array{true, false, false}));
  ASSERT_EQ(frame->rows(), 2u);
  EXPECT_EQ(frame->at(1, *frame->find("x")), -1e-3);
  EXPECT_FALSE(frame->find("y"));
  EXPECT_TRUE(dump.next());
  EXPECT_FALSE(dump.next());
}

TEST(Lammps, NamesFileAndLineOfWhatIsWrong) {
  const Scratch scratch;
  const auto text_of = [&](const std::string& content) {
    write_file(scratch / "a.dump", content);
    return error_of<InputError>([&] { LammpsDump(scratch / "a.dump").next(); });
  };
  const std::string good = atoms;
  EXPECT_TRUE(contains(text_of(good.substr(0, good.rfind("3 -1e-3"))), "after 1 of 2 rows"));
  EXPECT_TRUE(
      contains(text_of(good.substr(0, good.rfind("3 -1e-3")) + "3 abc\n"), "a.dump:15:1: error: 'abc' in column x"));
  EXPECT_TRUE(contains(text_of(good.substr(0, good.rfind("3 -1e-3")) + "3\n"), "1 values, expected 2"));
  EXPECT_TRUE(contains(text_of("ITEM: BOX BOUNDS xy xz yz pp pp pp\n"), "not orthogonal"));
  EXPECT_TRUE(contains(text_of("hello\n"), "ITEM:"));
  EXPECT_THROW(LammpsDump(scratch / "none.dump"), IoError);
}

TEST(Mercury, ReadsParticlesAndContacts) {
  const Scratch scratch;
  write_file(scratch / "a.data", "1 0.5 0 0 0 1 2 3\n.1 .2 .3 4 5 6 .5 0 0 0 7 8 9 1\n");
  MercuryData data(scratch / "a.data");
  const auto p = data.next();
  ASSERT_TRUE(p);
  EXPECT_EQ(p->time, 0.5);
  EXPECT_EQ(p->hi, (Vec3{1, 2, 3}));
  EXPECT_EQ(p->omega[0], (Vec3{7, 8, 9}));
  EXPECT_EQ(p->info[0], 1);
  EXPECT_FALSE(data.next());

  write_file(scratch / "a.fstat",
             "# 0.5 0\n# 0 0 0 1 2 3\n# .5 .5 0 0 0 0\n"
             "0.5 0 1 0 0 0 0.01 0 3 4 1 0 0 0 1 0\n"
             "0.5 0 -2 0 0 0 0.01 0 3 4 0 0 -1 1 0 0\n"
             "# 0.6 0\n# 0 0 0 1 2 3\n# .5 .5 0 0 0 0\n");
  MercuryFstat fstat(scratch / "a.fstat");
  const auto c = fstat.next();
  ASSERT_TRUE(c);
  ASSERT_EQ(c->contacts.size(), 2u);
  EXPECT_EQ(c->contacts[0].force, (Vec3{3, 4, 0}));
  EXPECT_EQ(c->contacts[1].j, -2);
  EXPECT_EQ(c->contacts[1].normal, (Vec3{0, 0, 1}));  // from the wall to the particle, unlike in the file
  EXPECT_EQ(c->contacts[1].force, (Vec3{-4, 0, 3}));
  const auto none = fstat.next();
  ASSERT_TRUE(none);
  EXPECT_EQ(none->time, 0.6);
  EXPECT_TRUE(none->contacts.empty());
  EXPECT_FALSE(fstat.next());
}

TEST(Mercury, NamesFileAndLineOfWhatIsWrong) {
  const Scratch scratch;
  const auto data = [&](const std::string& content) {
    write_file(scratch / "a.data", content);
    return error_of<InputError>([&] { MercuryData(scratch / "a.data").next(); });
  };
  EXPECT_TRUE(contains(data("1 0.5 0 0 1 1\n"), "a.data:1:1: error: 6 numbers"));  // two dimensions
  EXPECT_TRUE(contains(data("2 0.5 0 0 0 1 2 3\n0 0 0 0 0 0 1 0 0 0 0 0 0 0\n"), "after 1 of 2"));
  EXPECT_TRUE(contains(data("1 0.5 0 0 0 1 2 3\n0 0 0\n"), "a.data:2:1: error: 3 numbers, expected 14"));
  write_file(scratch / "a.fstat", "0.5 0 1\n");
  EXPECT_TRUE(
      contains(error_of<InputError>([&] { MercuryFstat(scratch / "a.fstat").next(); }), "header of an instant"));
}

}  // namespace
}  // namespace bagnold::io
