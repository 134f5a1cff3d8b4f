// Gives libFuzzer the mutations of a target. A share of plain changes of bytes stays, since those find what nobody
// thought of; with KITH_FUZZ_BYTES set there are no others, for comparison.

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "fuzzing.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using kith::fuzzing::Dice;

constexpr std::size_t kOneOfBytes = 10;

bool bytes_only() {
  static const bool kSet = std::getenv("KITH_FUZZ_BYTES") != nullptr;
  return kSet;
}

// What libFuzzer chose. It keeps mostly inputs that are malformed or refused, since there are so many ways to be; of
// these only a part is taken, and otherwise one that came further, half of the time with a piece of what was chosen.
std::string base_of(std::string_view chosen, Dice& dice) {
  using kith::fuzzing::Outcome;
  constexpr std::size_t kOneMalformed = 8;
  std::string base{chosen};
  const auto& outcomes = kith::fuzzing::outcomes();
  const auto outcome = outcomes.of(chosen);
  if (!outcome || outcome == Outcome::kRead) return base;
  const bool malformed = outcome == Outcome::kMalformed;
  if (malformed ? dice.one_in(kOneMalformed) : dice.one_in(2)) return base;
  if (auto other = outcomes.one_that(malformed ? Outcome::kRefused : Outcome::kRead, dice); !other.empty()) {
    base = std::move(other);
  }
  return dice.one_in(2) ? kith::fuzzing::crossed(base, chosen, dice) : base;
}

std::size_t put(const std::string& input, std::uint8_t* out) {
  std::memcpy(out, input.data(), input.size());
  return input.size();
}

std::string_view text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  constexpr int kMostTries = 4;
  Dice dice{seed};
  if (bytes_only() || dice.one_in(kOneOfBytes)) return LLVMFuzzerMutate(data, size, max_size);
  const auto base = base_of(text(data, size), dice);
  for (int tries = 0; tries < kMostTries; ++tries) {
    const auto input = kith::fuzzing::mutated(base, dice);
    if (!input.empty() && input.size() <= max_size && input != text(data, size)) return put(input, data);
  }
  return LLVMFuzzerMutate(data, size, max_size);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data, std::size_t size, const std::uint8_t* other,
                                                 std::size_t other_size, std::uint8_t* out, std::size_t max_size,
                                                 unsigned int seed) {
  if (bytes_only()) {
    put(std::string{text(data, std::min(size, max_size))}, out);
    return LLVMFuzzerMutate(out, std::min(size, max_size), max_size);
  }
  Dice dice{seed};
  const auto input = kith::fuzzing::crossed(text(data, size), text(other, other_size), dice);
  return put(input.substr(0, max_size), out);
}
