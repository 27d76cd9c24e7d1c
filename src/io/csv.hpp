// Tables as text. Numbers are written in the shortest form that reads back to the same bits; NaN, a number
// that does not exist, is an empty cell.
#pragma once
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/columns.hpp"

namespace bagnold::io {

enum class CsvHeader { names, names_and_units };  // one row (series.csv) or two (profile.csv)

// A table that grows by rows while a run goes on. Every row is handed to the operating system when it is
// complete.
class CsvWriter {
 public:
  // Replaces what is there.
  static CsvWriter create(const std::filesystem::path& path, const std::vector<Column>& columns,
                          CsvHeader header = CsvHeader::names);
  // Goes on with an existing table after dropping rows whose first column exceeds `until` and a last row cut
  // short by a crash; starts a new one when there is none. Throws InputError when the columns differ.
  static CsvWriter resume(const std::filesystem::path& path, const std::vector<Column>& columns, double until,
                          CsvHeader header = CsvHeader::names);
  void row(std::span<const double> values);  // one per column

 private:
  CsvWriter(std::filesystem::path path, std::size_t columns);
  std::filesystem::path path_;
  std::size_t columns_;
  std::ofstream out_;
};

// A whole table at once, replacing the file in one step. columns[k] holds the cells of column k.
void write_csv(const std::filesystem::path& path, const std::vector<Column>& columns,
               const std::vector<std::vector<double>>& cells, CsvHeader header = CsvHeader::names);

// A table read back. Empty cells are NaN.
struct CsvTable {
  std::string source;                      // for error messages
  std::vector<std::string> names, units;   // units: empty for a table without
  std::vector<std::vector<double>> cells;  // cells[k] is column k
  std::size_t rows() const { return cells.empty() ? 0 : cells[0].size(); }
  bool has(const std::string& name) const;
  const std::vector<double>& operator[](const std::string& name) const;  // throws IoError naming the known columns
};
CsvTable read_csv(const std::filesystem::path& path, CsvHeader header = CsvHeader::names);

}  // namespace bagnold::io
