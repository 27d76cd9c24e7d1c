#include "io/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/error.hpp"
#include "io/files.hpp"

namespace bagnold::io {
namespace {

std::string join(const std::vector<Column>& columns, std::string Column::*part) {
  std::string line;
  for (std::size_t k = 0; k < columns.size(); ++k) line += (k == 0 ? "" : ",") + columns[k].*part;
  return line + "\n";
}

std::string header_of(const std::vector<Column>& columns, CsvHeader header) {
  return join(columns, &Column::name) + (header == CsvHeader::names_and_units ? join(columns, &Column::unit) : "");
}

void append_number(std::string& line, double value) {
  if (!std::isnan(value)) fmt::format_to(std::back_inserter(line), "{}", value);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> number(std::string_view cell) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

// The complete lines of `text`: what follows the last newline was cut short and does not count.
std::vector<std::string_view> lines(std::string_view text) {
  std::vector<std::string_view> all;
  for (auto end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    auto line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    all.push_back(line);
    text.remove_prefix(end + 1);
  }
  return all;
}

}  // namespace

CsvWriter::CsvWriter(std::filesystem::path path, std::size_t columns) : path_(std::move(path)), columns_(columns) {
  out_.open(path_, std::ios::binary | std::ios::app);
  if (!out_) throw IoError(fmt::format("{}: error: cannot open for writing", path_.string()));
}

CsvWriter CsvWriter::create(const std::filesystem::path& path, const std::vector<Column>& columns, CsvHeader header) {
  write_file(path, header_of(columns, header));
  return {path, columns.size()};
}

CsvWriter CsvWriter::resume(const std::filesystem::path& path, const std::vector<Column>& columns, double until,
                            CsvHeader header) {
  if (!std::filesystem::exists(path)) return create(path, columns, header);
  const auto text = read_file(path);
  auto kept = header_of(columns, header);
  if (!text.starts_with(kept)) throw InputError(fmt::format("{}: error: the table has other columns", path.string()));
  for (const auto line : lines(std::string_view(text).substr(kept.size()))) {
    const auto cells = split(line);
    const auto t = number(cells[0]);
    if (cells.size() == columns.size() && t && *t <= until) kept.append(line) += '\n';
  }
  write_file(path, kept);
  return {path, columns.size()};
}

void CsvWriter::row(std::span<const double> values) {
  if (values.size() != columns_)
    throw IoError(fmt::format("{}: error: {} values for {} columns", path_.string(), values.size(), columns_));
  std::string line;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k > 0) line += ',';
    append_number(line, values[k]);
  }
  line += '\n';
  out_.write(line.data(), static_cast<std::streamsize>(line.size()));
  out_.flush();
  if (!out_) throw IoError(fmt::format("{}: error: cannot write", path_.string()));
}

void write_csv(const std::filesystem::path& path, const std::vector<Column>& columns,
               const std::vector<std::vector<double>>& cells, CsvHeader header) {
  if (cells.size() != columns.size() ||
      std::any_of(cells.begin(), cells.end(), [&](const auto& c) { return c.size() != cells[0].size(); }))
    throw IoError(fmt::format("{}: error: the columns of the table differ in length", path.string()));
  auto text = header_of(columns, header);
  const std::size_t rows = cells.empty() ? 0 : cells[0].size();
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (k > 0) text += ',';
      append_number(text, cells[k][i]);
    }
    text += '\n';
  }
  write_file(path, text);
}

bool CsvTable::has(const std::string& name) const { return std::find(names.begin(), names.end(), name) != names.end(); }

const std::vector<double>& CsvTable::operator[](const std::string& name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw IoError(fmt::format("{}: error: no column '{}'; known: {}", source, name, fmt::join(names, ", ")));
  return cells[static_cast<std::size_t>(at - names.begin())];
}

CsvTable read_csv(const std::filesystem::path& path, CsvHeader header) {
  auto text = read_file(path);
  if (!text.empty() && text.back() != '\n') text += '\n';
  const auto all = lines(text);
  const std::size_t heads = header == CsvHeader::names ? 1 : 2;
  if (all.size() < heads) throw IoError(fmt::format("{}: error: no header row", path.string()));
  CsvTable table{.source = path.string(), .names = {}, .units = {}, .cells = {}};
  for (const auto name : split(all[0])) table.names.emplace_back(name);
  if (heads == 2)
    for (const auto unit : split(all[1])) table.units.emplace_back(unit);
  table.cells.resize(table.names.size());
  for (std::size_t i = heads; i < all.size(); ++i) {
    const auto cells = split(all[i]);
    if (cells.size() != table.names.size())
      throw IoError(
          fmt::format("{}:{}: error: {} cells, expected {}", path.string(), i + 1, cells.size(), table.names.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const auto value = number(cells[k]);
      if (!value) throw IoError(fmt::format("{}:{}: error: '{}' is not a number", path.string(), i + 1, cells[k]));
      table.cells[k].push_back(*value);
    }
  }
  return table;
}

}  // namespace bagnold::io
