#include <map>

#include "app/model.hpp"
#include "config/case.hpp"

namespace bagnold::app {

std::unique_ptr<Model> make_model(config::Case& input) {
  // One line per model.
  static const std::map<std::string, std::unique_ptr<Model> (*)(config::Case&)> models = {
      {"dem", make_dem},
      {"shallow", make_shallow},
      {"sph", make_sph},
  };
  std::vector<std::string> names;
  for (const auto& [name, make] : models) names.push_back(name);
  return models.at(input.root().choose("model", std::nullopt, names))(input);
}

}  // namespace bagnold::app
