#include "app/topics.hpp"

#include "app/driver.hpp"
#include "app/time_keys.hpp"

namespace bagnold::app {

std::vector<Topic> all_topics() {
  std::vector<Topic> topics;
  add_dem_topics(topics);
  add_shallow_topics(topics);
  add_sph_topics(topics);
  topics.push_back(topic<TimeKeys>("section of models sph and shallow"));
  topics.push_back(topic<OutputSettings>("section of every case"));
  return topics;
}

}  // namespace bagnold::app
