#include "io/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <iterator>

#include "core/error.hpp"
#include "io/files.hpp"

extern char** environ;

namespace bagnold::io {
namespace {

struct Finished {
  bool started = false;
  int status = 0;
  std::string output;  // stdout and stderr
};

Finished run_gnuplot(const std::string& argument) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw IoError("gnuplot: error: cannot create a pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], 1);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], 2);
  std::string program = "gnuplot", argument_copy = argument;
  std::array<char*, 3> argv{program.data(), argument_copy.data(), nullptr};
  pid_t child = 0;
  Finished finished;
  finished.started = posix_spawnp(&child, "gnuplot", &actions, nullptr, argv.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  ::close(pipe[1]);
  if (finished.started) {
    std::array<char, 4096> buffer{};
    for (ssize_t n = 0; (n = ::read(pipe[0], buffer.data(), buffer.size())) > 0;)
      finished.output.append(buffer.data(), static_cast<std::size_t>(n));
    ::waitpid(child, &finished.status, 0);
  }
  ::close(pipe[0]);
  return finished;
}

std::string terminal(const std::filesystem::path& output, const PlotSize& size) {
  const auto kind = output.extension();
  if (kind == ".svg")
    return fmt::format("set terminal svg size {},{} dynamic enhanced font 'sans,13' background '#ffffff'\n", size.width,
                       size.height);
  if (kind == ".png")
    return fmt::format("set terminal pngcairo size {},{} enhanced font 'sans,10'\n", size.width, size.height);
  if (kind == ".pdf")
    return fmt::format("set terminal pdfcairo size {},{} enhanced font 'sans,10'\n", size.width / 72.0,
                       size.height / 72.0);
  throw IoError(fmt::format("{}: error: expected a figure name ending in .svg, .png or .pdf", output.string()));
}

std::string data_block(const PlotData& data) {
  std::string text = fmt::format("${} << EOD\n", data.name);
  const std::size_t rows = data.columns.empty() ? 0 : data.columns[0].size();
  for (std::size_t i = 0; i < rows; ++i) {
    for (const auto& column : data.columns) {
      if (std::isnan(column.at(i))) {
        text += "NaN ";
      } else {
        fmt::format_to(std::back_inserter(text), "{} ", column.at(i));
      }
    }
    text += '\n';
  }
  return text + "EOD\n";
}

std::string quoted(const std::filesystem::path& path) {
  std::string text = "'";
  for (const char c : path.string()) text += c == '\'' ? std::string("''") : std::string(1, c);
  return text + "'";
}

}  // namespace

bool have_gnuplot() {
  const auto finished = run_gnuplot("--version");
  return finished.started && finished.status == 0;
}

void plot(const std::filesystem::path& output, const std::string& script, const std::vector<PlotData>& data,
          const PlotSize& size) {
  auto text = terminal(output, size) +
              fmt::format("set output {}\nset encoding utf8\nset datafile missing NaN\n", quoted(output));
  for (const auto& block : data) text += data_block(block);
  text += script + "\nunset output\n";
  const std::filesystem::path file = output.string() + ".gp";
  write_file(file, text);
  const auto finished = run_gnuplot(file.string());
  if (!finished.started)
    throw IoError(fmt::format("{}: error: gnuplot is not installed (package gnuplot-nox)", output.string()));
  if (finished.status != 0)
    throw IoError(fmt::format("{}: error: gnuplot failed:\n{}(script kept as {})", output.string(), finished.output,
                              file.string()));
  std::filesystem::remove(file);
}

}  // namespace bagnold::io
