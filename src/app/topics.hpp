// Everything `bagnold explain` can speak of, read off the registries and the self-described sections.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/describe.hpp"

namespace bagnold::app {

struct Topic {
  std::string family;  // "normal contact law (contact.normal)"
  std::string name, summary, text;
};

template <class T>
Topic topic(std::string_view family) {
  return {std::string(family), std::string(T::name), std::string(T::summary), config::describe<T>()};
}

template <class Registry>
void add_registry(std::vector<Topic>& topics, std::string_view family) {
  Registry::for_each([&](const auto& law) { topics.push_back(topic<std::decay_t<decltype(law)>>(family)); });
}

std::vector<Topic> all_topics();
void add_dem_topics(std::vector<Topic>& topics);
void add_shallow_topics(std::vector<Topic>& topics);
void add_sph_topics(std::vector<Topic>& topics);

}  // namespace bagnold::app
