// An output quantity says what it is where it is made: its name, unit and meaning travel to every file.
#pragma once
#include <string>
#include <vector>

namespace bagnold::io {

struct Column {
  std::string name, unit, meaning;
};

}  // namespace bagnold::io
