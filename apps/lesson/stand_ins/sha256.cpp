// SHA-256 (FIPS 180-4), which the program has of OpenSSL.
#include "kith/files/sha256.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace kith {
namespace {

constexpr std::array<std::uint32_t, 64> kRound{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

constexpr std::uint32_t turned(std::uint32_t x, int n) { return x >> n | x << (32 - n); }

}  // namespace

struct Sha256::State {
  std::array<std::uint32_t, 8> hash{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                    0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block{};
  std::uint64_t size = 0;

  void put(unsigned char byte) {
    block[size++ % 64] = byte;
    if (size % 64 == 0) mix();
  }

  void mix() {
    std::array<std::uint32_t, 64> w{};
    for (std::size_t i = 0; i < 64; ++i) w[i / 4] = w[i / 4] << 8 | block[i];
    for (std::size_t i = 16; i < 64; ++i) {
      const auto a = turned(w[i - 15], 7) ^ turned(w[i - 15], 18) ^ w[i - 15] >> 3;
      const auto b = turned(w[i - 2], 17) ^ turned(w[i - 2], 19) ^ w[i - 2] >> 10;
      w[i] = w[i - 16] + a + w[i - 7] + b;
    }
    auto h = hash;
    for (std::size_t i = 0; i < 64; ++i) {
      const auto a = turned(h[4], 6) ^ turned(h[4], 11) ^ turned(h[4], 25);
      const auto first = h[7] + a + ((h[4] & h[5]) ^ (~h[4] & h[6])) + kRound[i] + w[i];
      const auto b = turned(h[0], 2) ^ turned(h[0], 13) ^ turned(h[0], 22);
      const auto second = b + ((h[0] & h[1]) ^ (h[0] & h[2]) ^ (h[1] & h[2]));
      h = {first + second, h[0], h[1], h[2], h[3] + first, h[4], h[5], h[6]};
    }
    for (std::size_t i = 0; i < 8; ++i) hash[i] += h[i];
  }
};

Sha256::Sha256() : state_{std::make_unique<State>()} {}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::update(std::string_view bytes) {
  for (const char byte : bytes) state_->put(static_cast<unsigned char>(byte));
}

std::string Sha256::digest() && {
  const std::uint64_t bits = state_->size * 8;
  state_->put(0x80);
  while (state_->size % 64 != 56) state_->put(0);
  for (int shift = 56; shift >= 0; shift -= 8) state_->put(static_cast<unsigned char>(bits >> shift));
  std::string digest;
  for (const auto word : state_->hash) {
    for (int shift = 24; shift >= 0; shift -= 8) digest += static_cast<char>(word >> shift & 0xFFu);
  }
  return digest;
}

}  // namespace kith
