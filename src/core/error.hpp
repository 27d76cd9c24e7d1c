// What can go wrong, by whose fault it is. main() maps each to the exit code of the contract.
#pragma once
#include <stdexcept>
#include <string>

namespace bagnold {

// Bad usage or input (exit 2). The text reads `file:line:col: error: what, what was expected, nearest known key`.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A value outside the range where the numbers mean something, found below the reader, which adds the location (exit 2).
struct UnphysicalError : InputError {
  UnphysicalError(std::string key_, std::string text_)
      : InputError(key_ + ": " + text_), key(std::move(key_)), text(std::move(text_)) {}
  std::string key;   // dotted key it is about, for example "time.step"
  std::string text;  // what is wrong with it
};

// The computation left the range where it means something (exit 3): says which grain, particle or cell, when and why.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A file could not be read or written (exit 4).
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace bagnold
