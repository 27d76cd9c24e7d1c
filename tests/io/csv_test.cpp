#include "io/csv.hpp"

#include <bit>
#include <cmath>
#include <random>

#include "core/error.hpp"
#include "io/files.hpp"
#include "scratch.hpp"

namespace bagnold::io {
namespace {

const std::vector<Column> columns{{"t", "s", "time"}, {"e", "J", "energy"}};
const double none = std::numeric_limits<double>::quiet_NaN();

TEST(Csv, EveryDoubleComesBackBitForBit) {
  const Scratch dir;
  std::mt19937_64 random(1);
  std::vector<double> values{0.1, -0.0, 5e-324, std::numeric_limits<double>::max(),
                             std::numeric_limits<double>::infinity()};
  while (values.size() < 2000)
    if (const auto v = std::bit_cast<double>(random()); !std::isnan(v)) values.push_back(v);
  auto csv = CsvWriter::create(dir / "a.csv", columns);
  for (const double v : values) csv.row(std::vector{v, -v});
  const auto table = read_csv(dir / "a.csv");
  ASSERT_EQ(table.rows(), values.size());
  for (std::size_t k = 0; k < values.size(); ++k)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(table["t"][k]), std::bit_cast<std::uint64_t>(values[k]));
}

TEST(Csv, HeadersUnitsAndMissingNumbers) {
  const Scratch dir;
  write_csv(dir / "p.csv", columns, {{0, 0.5}, {none, 2}}, CsvHeader::names_and_units);
  EXPECT_EQ(read_file(dir / "p.csv"), "t,e\ns,J\n0,\n0.5,2\n");
  const auto table = read_csv(dir / "p.csv", CsvHeader::names_and_units);
  EXPECT_EQ(table.units, (std::vector<std::string>{"s", "J"}));
  EXPECT_TRUE(std::isnan(table["e"][0]));
  EXPECT_TRUE(contains(error_of<IoError>([&] { table["x"]; }), "no column 'x'; known: t, e"));
}

TEST(Csv, ResumingDropsLaterRowsAndARowCutShort) {
  const Scratch dir;
  auto csv = CsvWriter::create(dir / "a.csv", columns);
  for (const double t : {0.0, 0.1, 0.2, 0.30000000000000004}) csv.row(std::vector{t, 1.0});
  for (const char* rest : {"", "0.", "0.2", "0.2,", "0.2,1"}) {
    write_file(dir / "b.csv", read_file(dir / "a.csv") + rest);
    CsvWriter::resume(dir / "b.csv", columns, 0.2).row(std::vector{0.25, 2.0});
    EXPECT_EQ(read_file(dir / "b.csv"), "t,e\n0,1\n0.1,1\n0.2,1\n0.25,2\n") << rest;
  }
  CsvWriter::resume(dir / "new.csv", columns, 1);
  EXPECT_EQ(read_file(dir / "new.csv"), "t,e\n");
}

TEST(Csv, Errors) {
  const Scratch dir;
  auto csv = CsvWriter::create(dir / "a.csv", columns);
  EXPECT_TRUE(contains(error_of<IoError>([&] { csv.row(std::vector{1.0}); }), "1 values for 2 columns"));
  EXPECT_TRUE(contains(error_of<InputError>([&] {
                         CsvWriter::resume(dir / "a.csv", {{"t", "s", ""}}, 0);
                       }),
                       "other columns"));
  write_file(dir / "b.csv", "t,e\n1,2\n3\n");
  EXPECT_TRUE(contains(error_of<IoError>([&] { read_csv(dir / "b.csv"); }), "b.csv:3: error: 1 cells, expected 2"));
  write_file(dir / "c.csv", "t,e\n1,two\n");
  EXPECT_TRUE(contains(error_of<IoError>([&] { read_csv(dir / "c.csv"); }), "c.csv:2: error: 'two' is not a number"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { read_csv(dir / "none.csv"); }), "No such file"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { write_csv(dir / "no/d.csv", columns, {{}, {}}); }), "cannot create"));
  EXPECT_TRUE(contains(error_of<IoError>([&] { write_csv(dir / "d.csv", columns, {{1}, {}}); }), "differ in length"));
}

}  // namespace
}  // namespace bagnold::io
