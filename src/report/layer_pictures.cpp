#include "report/layer_pictures.hpp"

#include <algorithm>
#include <cmath>

namespace bagnold::report {

std::vector<std::size_t> chosen(std::size_t snapshots, std::size_t most) {
  std::vector<std::size_t> which;
  const std::size_t count = std::min(snapshots, most);
  for (std::size_t k = 0; k < count; ++k)
    which.push_back(count == 1 ? snapshots - 1 : (k * (snapshots - 1) + (count - 1) / 2) / (count - 1));
  return which;
}

std::vector<Picture> layer_pictures(const std::vector<LayerRun>& runs) {
  std::vector<Picture> all;
  for (const LayerRun& run : runs)
    for (Picture& picture : run.layers->grid().two_d() ? map_pictures(run) : profile_pictures(run)) {
      if (runs.size() > 1) {
        picture.name += "_" + run.name;
        picture.caption = run.name + ": " + picture.caption;
      }
      all.push_back(std::move(picture));
    }
  return all;
}

}  // namespace bagnold::report
