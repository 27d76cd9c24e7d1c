// The particle engine as coarse-graining sees it.
#pragma once
#include <vector>

#include "cg/blocks.hpp"
#include "cg/snapshot.hpp"
#include "dem/algorithm.hpp"
#include "dem/contact_model.hpp"
#include "dem/state.hpp"

namespace bagnold::cg {

// Memory that a snapshot of a running engine refers to, kept between calls.
struct DemScratch {
  std::vector<Vec3> v, omega;  // at the time of the positions
  std::vector<dem::Contact> contacts;
};

// Reads the state and changes nothing; valid until the state or the scratch changes.
Snapshot snapshot_of(const dem::DemState& state, const dem::ContactLaws& laws, DemScratch& scratch);

// What a run averages and when (keys of the section [cg] of a case).
struct StreamingOptions {
  laws::CgKernels::Any kernel;
  double spacing = 0;                                     // of the nodes; 0: a quarter of the kernel width
  std::int64_t first_step = 0, last_step = 0, every = 1;  // samples at first_step, first_step + every, ... <= last_step
  std::int64_t samples_expected() const { return last_step >= first_step ? (last_step - first_step) / every + 1 : 0; }
};

// Averages depth profiles while a run goes on.
class ProfileObserver {
 public:
  ProfileObserver(const StreamingOptions& options, const Box& box);

  // To be handed to dem::advance(); valid as long as this observer and the laws are.
  dem::Watch watch(const dem::ContactLaws& laws);

  const BlockedProfile& profile() const { return profile_; }
  std::vector<NamedArray> state() { return profile_.state("cg/"); }

 private:
  StreamingOptions options_;
  BlockedProfile profile_;
};

}  // namespace bagnold::cg
