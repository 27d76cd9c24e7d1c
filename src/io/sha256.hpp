// SHA-256 (FIPS 180-4): a name for content that nothing else will ever have.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>

namespace bagnold::io {

// Of the parts one after the other, as 64 hexadecimal digits.
std::string sha256(std::initializer_list<std::span<const std::byte>> parts);

}  // namespace bagnold::io
