// Gives libFuzzer the mutations of a target. A share of plain changes of bytes stays, since those find what nobody
// thought of; with KITH_FUZZ_BYTES set there are no others, for comparison.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "fuzzing.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using kith::fuzzing::Dice;
using kith::fuzzing::Outcome;

constexpr std::size_t kOneOfBytes = 10;

bool bytes_only() {
  static const bool kSet = std::getenv("KITH_FUZZ_BYTES") != nullptr;
  return kSet;
}

// How far inputs came, printed at the end since libFuzzer ends the program itself; and the latest that were read. Takes
// all its memory at the beginning: libFuzzer looks for leaks after every input that allocates more than it frees, which
// takes a hundred times longer than most inputs.
class Outcomes {
 public:
  Outcomes() {
    for (auto& input : read_) input.reserve(kLongest);
  }
  ~Outcomes() {
    constexpr std::array<const char*, 3> kNames{"malformed", "refused", "read"};
    for (std::size_t i = 0; i < counts_.size(); ++i)
      std::fprintf(stderr, "stat::%s_inputs: %zu\n", kNames.at(i), counts_.at(i));
  }
  Outcomes(const Outcomes&) = delete;
  Outcomes& operator=(const Outcomes&) = delete;

  void add(std::string_view input, Outcome outcome) {
    auto& count = counts_.at(static_cast<std::size_t>(outcome));
    if (outcome == Outcome::kRead && input.size() <= kLongest) read_.at(count % read_.size()) = input;
    ++count;
  }
  // One that was read, half of the time with a piece of what libFuzzer chose, which keeps mostly inputs that are
  // malformed or refused, since there are so many ways to be.
  [[nodiscard]] std::string better_than(std::string_view chosen, Dice& dice) const {
    const auto& read = dice.pick(read_);
    if (read.empty()) return std::string{chosen};
    return dice.one_in(2) ? kith::fuzzing::crossed(read, chosen, dice) : read;
  }

 private:
  static constexpr std::size_t kLongest = 2048;
  std::array<std::size_t, 3> counts_{};
  std::array<std::string, 128> read_{};
};

Outcomes& outcomes() {
  static Outcomes all;
  return all;
}

std::size_t put(const std::string& input, std::uint8_t* out) {
  std::memcpy(out, input.data(), input.size());
  return input.size();
}

std::string_view text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  outcomes().add(text(data, size), kith::fuzzing::run(text(data, size)));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  constexpr int kMostTries = 4;
  Dice dice{seed};
  if (bytes_only() || dice.one_in(kOneOfBytes)) return LLVMFuzzerMutate(data, size, max_size);
  const auto base = dice.one_in(2) ? std::string{text(data, size)} : outcomes().better_than(text(data, size), dice);
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
