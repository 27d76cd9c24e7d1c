#include "core/cpu_limit.hpp"

#include <sched.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace bagnold {

namespace {

std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; (begin = text.find_first_not_of(separators, begin)) != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

std::optional<double> number(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::optional<double> ratio(std::optional<double> quota, std::optional<double> period) {
  if (!quota || !period || !(*quota > 0) || !(*period > 0)) return std::nullopt;  // -1: no limit
  return *quota / *period;
}

// A mounted hierarchy that counts CPU time: where, and which group its top is.
struct Mount {
  bool v2 = false;
  std::string point, root;
};

// Line of mountinfo: id parent device root point options [optional ...] - type source super-options (proc(5)).
std::optional<Mount> cpu_mount(std::string_view line) {
  const auto words = split(line, " ");
  const auto dash = std::find(words.begin(), words.end(), "-");
  if (words.size() < 6 || words.end() - dash < 3) return std::nullopt;
  const std::string_view type = dash[1];
  const auto controllers = split(words.back(), ",");
  const bool v2 = type == "cgroup2";
  if (!v2 && (type != "cgroup" || std::find(controllers.begin(), controllers.end(), "cpu") == controllers.end()))
    return std::nullopt;
  return Mount{v2, std::string(words[4]), std::string(words[3])};
}

// The group of this process in that hierarchy; line: number:controllers:path, without controllers in version 2.
std::optional<std::string> group_in(const Mount& mount, std::string_view cgroup) {
  for (const std::string_view line : split(cgroup, "\n")) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == line.npos || second == line.npos) continue;
    const auto controllers = split(line.substr(first + 1, second - first - 1), ",");
    const bool cpu = std::find(controllers.begin(), controllers.end(), "cpu") != controllers.end();
    if (mount.v2 ? controllers.empty() : cpu) return std::string(line.substr(second + 1));
  }
  return std::nullopt;
}

std::optional<double> quota_of(const Mount& mount, const std::string& directory, const ReadFile& read) {
  if (mount.v2) return quota_v2(read(directory + "/cpu.max").value_or(""));
  return quota_v1(read(directory + "/cpu.cfs_quota_us").value_or(""),
                  read(directory + "/cpu.cfs_period_us").value_or(""));
}

std::optional<std::string> contents(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

}  // namespace

std::optional<double> quota_v2(std::string_view cpu_max) {
  const auto words = split(cpu_max, " \n");
  if (words.size() != 2) return std::nullopt;
  return ratio(number(words[0]), number(words[1]));  // "max" is no number
}

std::optional<double> quota_v1(std::string_view quota_us, std::string_view period_us) {
  const auto quota = split(quota_us, " \n"), period = split(period_us, " \n");
  if (quota.size() != 1 || period.size() != 1) return std::nullopt;
  return ratio(number(quota[0]), number(period[0]));
}

std::optional<double> cpu_quota(std::string_view cgroup, std::string_view mountinfo, const ReadFile& read) {
  std::optional<double> least;
  for (const std::string_view line : split(mountinfo, "\n")) {
    const auto mount = cpu_mount(line);
    if (!mount) continue;
    // Seen from within a container the group may lie elsewhere than the hierarchy says; then the top is what there is.
    std::string below = group_in(*mount, cgroup).value_or("/");
    if (mount->root != "/" && below.starts_with(mount->root)) below.erase(0, mount->root.size());
    if (below.find("/..") != below.npos) below = "";
    while (true) {
      while (below.ends_with('/')) below.pop_back();
      if (const auto quota = quota_of(*mount, mount->point + below, read))
        least = std::min(*quota, least.value_or(*quota));
      if (below.empty()) break;
      below.resize(below.rfind('/') == below.npos ? 0 : below.rfind('/'));
    }
  }
  return least;
}

int allowed_threads(int processors, std::optional<double> quota) {
  const double allowed = std::min<double>(processors, std::floor(quota.value_or(processors) + 1e-9));
  return std::max(1, static_cast<int>(allowed));
}

int cpu_limit() {
  int processors = static_cast<int>(std::thread::hardware_concurrency());
  cpu_set_t mask;  // holds 1024; on a larger machine the call fails and the number of processors stands
  if (sched_getaffinity(0, sizeof mask, &mask) == 0) processors = CPU_COUNT(&mask);
  return allowed_threads(processors, cpu_quota(contents("/proc/self/cgroup").value_or(""),
                                               contents("/proc/self/mountinfo").value_or(""), contents));
}

}  // namespace bagnold
