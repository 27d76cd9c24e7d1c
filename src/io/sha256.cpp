#include "io/sha256.hpp"

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <array>

namespace bagnold::io {

std::string sha256(std::initializer_list<std::span<const std::byte>> parts) {
  sha256_ctx context;
  sha256_init(&context);
  for (const auto part : parts)
    sha256_update(&context, part.size(), reinterpret_cast<const std::uint8_t*>(part.data()));
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
  sha256_digest(&context, digest.size(), digest.data());
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace bagnold::io
