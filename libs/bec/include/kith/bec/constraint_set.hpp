#pragma once

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

/// A set of a domain's constraints, one bit each, in machine words.
class ConstraintSet {
 public:
  ConstraintSet() = default;
  /// The empty set among `capacity` constraints.
  explicit ConstraintSet(std::size_t capacity) : words_((capacity + kBits - 1) / kBits) {}
  /// A copy of a row of words.
  explicit ConstraintSet(std::span<const std::uint64_t> words) : words_(words.begin(), words.end()) {}

  [[nodiscard]] bool contains(ConstraintIndex c) const {
    return (words_[c.value() / kBits] >> (c.value() % kBits) & 1u) != 0;
  }
  void insert(ConstraintIndex c) { words_[c.value() / kBits] |= std::uint64_t{1} << (c.value() % kBits); }

  /// Union. @pre equal capacities.
  ConstraintSet& operator|=(const ConstraintSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
  }
  [[nodiscard]] friend ConstraintSet operator|(ConstraintSet a, const ConstraintSet& b) { return a |= b; }
  /// What is here and not in `other`.
  [[nodiscard]] ConstraintSet without(const ConstraintSet& other) const {
    ConstraintSet rest = *this;
    for (std::size_t i = 0; i < words_.size(); ++i) rest.words_[i] &= ~other.words_[i];
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

  friend bool operator==(const ConstraintSet&, const ConstraintSet&) = default;

 private:
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

template <>
struct std::hash<kith::ConstraintSet> {
  std::size_t operator()(const kith::ConstraintSet& set) const noexcept { return kith::hash_words(set.words()); }
};
