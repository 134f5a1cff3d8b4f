#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kith/core/index.hpp"

namespace kith {

/// A distinct half-space of one domain; see ConstraintTable.
using ConstraintIndex = Index<struct ConstraintTag>;

/// A set of a domain's constraints, one bit each, in machine words. It grows as
/// constraints with higher numbers come in; how far it has grown does not count
/// when sets are compared.
class ConstraintSet {
 public:
  ConstraintSet() = default;
  /// The empty set, with room for `capacity` constraints.
  explicit ConstraintSet(std::size_t capacity) : words_((capacity + kBits - 1) / kBits) {}
  /// A copy of a row of words.
  explicit ConstraintSet(std::span<const std::uint64_t> words) : words_(words.begin(), words.end()) {}

  [[nodiscard]] bool contains(ConstraintIndex c) const {
    const std::size_t word = c.value() / kBits;
    return word < words_.size() && (words_[word] >> (c.value() % kBits) & 1u) != 0;
  }
  void insert(ConstraintIndex c) {
    make_room(c.value() / kBits + 1);
    words_[c.value() / kBits] |= std::uint64_t{1} << (c.value() % kBits);
  }

  /// Union.
  ConstraintSet& operator|=(const ConstraintSet& other) {
    make_room(other.words_.size());
    for (std::size_t i = 0; i < other.words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
  }
  [[nodiscard]] friend ConstraintSet operator|(ConstraintSet a, const ConstraintSet& b) { return a |= b; }
  /// What is here and not in `other`.
  [[nodiscard]] ConstraintSet without(const ConstraintSet& other) const {
    ConstraintSet rest = *this;
    const std::size_t common = std::min(words_.size(), other.words_.size());
    for (std::size_t i = 0; i < common; ++i) rest.words_[i] &= ~other.words_[i];
    return rest;
  }

  /// The number of constraints in the set.
  [[nodiscard]] std::size_t count() const noexcept {
    std::size_t n = 0;
    for (const auto word : words_) n += static_cast<std::size_t>(std::popcount(word));
    return n;
  }
  [[nodiscard]] bool empty() const noexcept { return count() == 0; }
  /// The members in ascending order.
  [[nodiscard]] std::vector<ConstraintIndex> members() const {
    std::vector<ConstraintIndex> result;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      for (auto word = words_[i]; word != 0; word &= word - 1) {
        result.emplace_back(i * kBits + static_cast<std::size_t>(std::countr_zero(word)));
      }
    }
    return result;
  }

  [[nodiscard]] std::span<const std::uint64_t> words() const noexcept { return words_; }
  [[nodiscard]] std::span<std::uint64_t> words() noexcept { return words_; }
  /// The words up to the last that is not 0.
  [[nodiscard]] std::span<const std::uint64_t> used_words() const noexcept {
    std::size_t used = words_.size();
    while (used > 0 && words_[used - 1] == 0) --used;
    return {words_.data(), used};
  }

  friend bool operator==(const ConstraintSet& a, const ConstraintSet& b) noexcept {
    const auto left = a.used_words();
    const auto right = b.used_words();
    return std::equal(left.begin(), left.end(), right.begin(), right.end());
  }

 private:
  void make_room(std::size_t num_words) {
    if (words_.size() < num_words) words_.resize(num_words);
  }

  static constexpr std::size_t kBits = 64;
  std::vector<std::uint64_t> words_;
};

/// A hash of a row of words; equal rows hash equally.
[[nodiscard]] inline std::size_t hash_words(std::span<const std::uint64_t> words) noexcept {
  std::uint64_t hash = 0x9E3779B97F4A7C15ull;
  for (const auto word : words) {
    hash = (hash ^ word) * 0xBF58476D1CE4E5B9ull;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

}  // namespace kith

/// Not noexcept, so that tables of the C++ library keep the hashes of long keys.
template <>
struct std::hash<kith::ConstraintSet> {
  std::size_t operator()(const kith::ConstraintSet& set) const { return kith::hash_words(set.used_words()); }
};
