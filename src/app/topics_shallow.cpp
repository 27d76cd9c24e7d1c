#include <fmt/format.h>

#include "app/topics.hpp"
#include "closure/closure_set.hpp"
#include "scenario/shallow.hpp"

namespace bagnold::app {

void add_shallow_topics(std::vector<Topic>& topics) {
  add_registry<laws::FrictionLaws>(topics, "basal friction (closure.friction)");
  add_registry<laws::DensityLaws>(topics, "mean density (closure.density)");
  add_registry<laws::StressRatioLaws>(topics, "stress ratio (closure.stress_ratio)");
  add_registry<laws::ShapeFactorLaws>(topics, "shape factor (closure.shape_factor)");
  topics.push_back(topic<laws::StaticBranch>("starting and stopping (closure.static_branch)"));
  topics.push_back(topic<scenario::Incline>("shallow scenario"));
  topics.push_back(topic<scenario::RunOut>("shallow scenario"));
  topics.push_back(topic<scenario::Release>("shallow release"));
  for (const std::string& name : closure::builtin_names()) {
    const auto set = *closure::builtin(name, 1, 1);
    topics.push_back({"closure set (closure.set)", name, "measured closures: " + set.source, closure::describe(set)});
  }
}

}  // namespace bagnold::app
