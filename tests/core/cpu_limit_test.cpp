// What a process may use, from what the system says about affinity and quotas.
#include "core/cpu_limit.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <map>

#include "core/parallel.hpp"

namespace bagnold {
namespace {

using Files = std::map<std::string, std::string>;

ReadFile from(const Files& files) {
  return [&files](const std::string& path) -> std::optional<std::string> {
    const auto found = files.find(path);
    if (found == files.end()) return std::nullopt;
    return found->second;
  };
}

const std::string v2_mount = "30 23 0:26 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw,nsdelegate\n";
const std::string v1_mount =
    "23 1 0:20 / /proc rw - proc proc rw\n"
    "33 30 0:30 / /sys/fs/cgroup/memory rw shared:14 - cgroup cgroup rw,memory\n"
    "34 30 0:31 / /sys/fs/cgroup/cpu,cpuacct rw shared:15 - cgroup cgroup rw,cpu,cpuacct\n";

TEST(CpuQuota, OfOneGroup) {
  EXPECT_EQ(quota_v2("150000 100000\n"), 1.5);
  EXPECT_EQ(quota_v2("max 100000\n"), std::nullopt);
  EXPECT_EQ(quota_v1("200000\n", "50000\n"), 4);
  EXPECT_EQ(quota_v1("-1\n", "100000\n"), std::nullopt);
  for (const char* nonsense : {"", "max", "100000", "1e5x 100000", "100000 0", "0 100000", "1 2 3"})
    EXPECT_EQ(quota_v2(nonsense), std::nullopt) << nonsense;
  EXPECT_EQ(quota_v1("", "100000"), std::nullopt);
  EXPECT_EQ(quota_v1("100000", ""), std::nullopt);
}

TEST(CpuQuota, TheSmallestOnTheWayUp) {
  const std::string group = "0::/user.slice/user-1000.slice/job.scope\n";
  Files files{{"/sys/fs/cgroup/user.slice/user-1000.slice/job.scope/cpu.max", "max 100000\n"},
              {"/sys/fs/cgroup/user.slice/user-1000.slice/cpu.max", "300000 100000\n"},
              {"/sys/fs/cgroup/user.slice/cpu.max", "800000 100000\n"}};
  EXPECT_EQ(cpu_quota(group, v2_mount, from(files)), 3);
  files["/sys/fs/cgroup/user.slice/cpu.max"] = "200000 100000\n";
  EXPECT_EQ(cpu_quota(group, v2_mount, from(files)), 2);
  files["/sys/fs/cgroup/user.slice/user-1000.slice/job.scope/cpu.max"] = "50000 100000\n";
  EXPECT_EQ(cpu_quota(group, v2_mount, from(files)), 0.5);
  EXPECT_EQ(cpu_quota("0::/\n", v2_mount, from(files)), std::nullopt);
}

TEST(CpuQuota, OfVersionOneAndOfBothMounted) {
  const std::string group = "12:memory:/batch/job7\n4:cpu,cpuacct:/batch/job7\n0::/system.slice\n";
  Files files{{"/sys/fs/cgroup/cpu,cpuacct/batch/job7/cpu.cfs_quota_us", "400000\n"},
              {"/sys/fs/cgroup/cpu,cpuacct/batch/job7/cpu.cfs_period_us", "100000\n"},
              {"/sys/fs/cgroup/cpu,cpuacct/batch/cpu.cfs_quota_us", "-1\n"},
              {"/sys/fs/cgroup/cpu,cpuacct/batch/cpu.cfs_period_us", "100000\n"}};
  EXPECT_EQ(cpu_quota(group, v1_mount, from(files)), 4);
  const std::string hybrid = v1_mount + "35 30 0:32 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n";
  EXPECT_EQ(cpu_quota(group, hybrid, from(files)), 4);
  files["/sys/fs/cgroup/unified/system.slice/cpu.max"] = "100000 100000";
  EXPECT_EQ(cpu_quota(group, hybrid, from(files)), 1);
}

// The hierarchy may be mounted from the container's group on, or the group may lie outside of what can be seen.
TEST(CpuQuota, InContainers) {
  const Files v1{{"/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "250000"}, {"/sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000"}};
  EXPECT_EQ(cpu_quota("3:cpu:/docker/0a1b\n", "40 30 0:31 /docker/0a1b /sys/fs/cgroup/cpu ro - cgroup cgroup rw,cpu\n",
                      from(v1)),
            2.5);
  const Files v2{{"/sys/fs/cgroup/cpu.max", "200000 100000"}};
  EXPECT_EQ(cpu_quota("0::/\n", v2_mount, from(v2)), 2);
  EXPECT_EQ(cpu_quota("0::/../other\n", v2_mount, from(v2)), 2);
  EXPECT_EQ(cpu_quota("0::/not/visible\n", v2_mount, from(v2)), 2);
}

TEST(CpuQuota, NoneWhereNothingIsMountedOrSaid) {
  for (const char* text : {"", "0", "0:", "nonsense\n\n::\n", "30 23 0:26 / /x rw - cgroup2\n"}) {
    EXPECT_EQ(cpu_quota(text, v2_mount + v1_mount, from({})), std::nullopt);
    EXPECT_EQ(cpu_quota("0::/\n", text, from({})), std::nullopt);
  }
}

TEST(CpuLimit, WholeThreadsAndAtLeastOne) {
  EXPECT_EQ(allowed_threads(8, std::nullopt), 8);
  EXPECT_EQ(allowed_threads(8, 2.0), 2);
  EXPECT_EQ(allowed_threads(8, 2.9), 2);
  EXPECT_EQ(allowed_threads(2, 16.0), 2);
  EXPECT_EQ(allowed_threads(8, 0.3), 1);
  EXPECT_EQ(allowed_threads(0, std::nullopt), 1);
}

TEST(CpuLimit, FollowsTheAffinityMask) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  EXPECT_LE(cpu_limit(), CPU_COUNT(&before));
  int first = 0;
  while (!CPU_ISSET(first, &before)) ++first;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  EXPECT_EQ(cpu_limit(), 1);
  set_threads(2);
  EXPECT_EQ(threads(), 1);
  ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  set_threads(0);
}

}  // namespace
}  // namespace bagnold
