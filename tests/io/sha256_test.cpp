// The examples of FIPS 180-4 and of NIST's test vectors.
#include "io/sha256.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace bagnold::io {
namespace {

std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

TEST(Sha256, KnowsThePublishedExamples) {
  EXPECT_EQ(sha256({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256({bytes("abc")}), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256({bytes("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")}),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, OfPartsIsThatOfTheWhole) {
  EXPECT_EQ(sha256({bytes("a"), bytes(""), bytes("bc")}), sha256({bytes("abc")}));
  EXPECT_NE(sha256({bytes("abc")}), sha256({bytes("abd")}));
}

}  // namespace
}  // namespace bagnold::io
