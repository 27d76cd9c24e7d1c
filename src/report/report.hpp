// report.html: one file with everything in it, figures included, that can be mailed and opened anywhere.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace bagnold::report {

// Writes the report on the runs of `directories` to `output`, and its figures as .svg (and in each of `formats`, "png" or
// "pdf") into the folder "figures" next to it. Several runs share the figures and the table of numbers.
// Throws InputError for a directory without a run, IoError when a file cannot be written or gnuplot is missing.
void write_report(const std::vector<std::filesystem::path>& directories, const std::filesystem::path& output,
                  const std::vector<std::string>& formats = {});

}  // namespace bagnold::report
