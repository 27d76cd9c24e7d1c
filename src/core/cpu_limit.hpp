// How many processors this process may keep busy: those of its affinity mask, and what the CPU quota of its control
// group and of the groups above leaves (containers, batch systems).
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace bagnold {

// Processors' worth of CPU time, nothing if there is no limit or the text is no quota.
std::optional<double> quota_v2(std::string_view cpu_max);  // contents of cpu.max: "max 100000", "150000 100000"
std::optional<double> quota_v1(std::string_view quota_us, std::string_view period_us);  // cpu.cfs_*_us

// The smallest quota of the group and those above it, from the contents of /proc/self/cgroup and
// /proc/self/mountinfo; read(path): the contents of a file, nothing if it cannot be read.
using ReadFile = std::function<std::optional<std::string>(const std::string& path)>;
std::optional<double> cpu_quota(std::string_view cgroup, std::string_view mountinfo, const ReadFile& read);

// Whole threads that a mask of `processors` and a quota allow: rounded down, for a thread that the quota halts holds up
// the others, but at least one.
int allowed_threads(int processors, std::optional<double> quota);

int cpu_limit();  // of this process, now

}  // namespace bagnold
