// Beds take longest to prepare and depend on a few numbers only: they are kept in the user's cache folder
// ($XDG_CACHE_HOME/bagnold, else ~/.cache/bagnold) under a name made of those numbers.
#pragma once
#include "scenario/settled_bed.hpp"

namespace bagnold::app {

// The stored bed of this recipe, or a new one, which is then stored. A cache that cannot be used is not an error.
scenario::Bed stored_bed(const scenario::BedRecipe& recipe);

}  // namespace bagnold::app
