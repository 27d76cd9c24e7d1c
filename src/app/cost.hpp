// What a run will take of time, memory and disk. Speeds are those of the last runs of this machine, kept in the cache
// folder (speeds.json) by model, engine, SIMD variant and size.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "app/driver.hpp"
#include "app/model.hpp"

namespace bagnold::app {

// "1 min 20 s (2.1e+07 grain-steps/s, as lately here)": says whether the speed was measured or assumed.
std::string time_text(const Cost& cost, std::string_view model);

// Lines of `check` and of the start of a run: time, memory, disk of everything `output` asks for until `end`.
std::vector<Derived> cost_lines(const Cost& cost, std::string_view model, const OutputSettings& output, double end);

// What a process has done: `element_steps` in `wall_s`. Less than two seconds say nothing and are ignored, and so is a cache
// that cannot be written.
void remember_speed(const Cost& cost, std::string_view model, double element_steps, double wall_s);

}  // namespace bagnold::app
