#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "kith/domains/domain.hpp"
#include "kith/explain/words.hpp"

namespace kith::testing {

/// Reads a sentence about reward weights as somebody would who knows only the words of the domain: what it says, as an
/// inequality coefficients . w >= 0, and its condition.
class ReadSentence {
 public:
  ReadSentence(const Domain& domain, std::string text) : domain_{domain}, text_{std::move(text)} {
    if (takes("if ")) {
      condition_ = inequality();
      is_understood_ = is_understood_ && takes(", ");
    }
    said_ = inequality();
    is_understood_ = is_understood_ && at_ == text_.size();
  }

  [[nodiscard]] bool is_understood() const { return is_understood_; }
  [[nodiscard]] const std::optional<IntegerVector>& condition() const { return condition_; }
  [[nodiscard]] const IntegerVector& said() const { return said_; }

 private:
  bool takes(const std::string& what) {
    if (text_.compare(at_, what.size(), what) != 0) return false;
    at_ += what.size();
    return true;
  }

  // Number of letters of one thing at the current place, how often it occurs and which it is.
  struct Found {
    std::size_t letters = 0, feature = 0;
    std::int64_t n = 0;
  };

  [[nodiscard]] Found thing_here() const {
    constexpr std::int64_t kMost = 1000;
    Found best;
    for (std::size_t k = 0; k < domain_.num_features(); ++k) {
      for (std::int64_t n = 1; n <= kMost; ++n) {
        const auto read = [&](const std::string& words, std::int64_t count) {
          if (words.size() > best.letters && text_.compare(at_, words.size(), words) == 0) {
            best = {words.size(), k, count};
          }
        };
        read(times(domain_.wording(k), n), n);
        read(times_fewer(domain_.wording(k), n), -n);
      }
    }
    return best;
  }

  // "a", "a and b", "a, b and c"; a comma that ends a condition is no part of it.
  IntegerVector list() {
    IntegerVector sum(domain_.num_features());
    for (;;) {
      const auto found = thing_here();
      if (found.letters == 0) {
        is_understood_ = false;
        return sum;
      }
      sum[found.feature] += found.n;
      at_ += found.letters;
      if (!takes(" and ") && !takes(", ")) return sum;
    }
  }

  // The sign with which weights enter what is compared: costs are the negative of weights.
  std::optional<int> verb() {
    takes(" together");
    for (const char* cost : {" costs", " cost"}) {
      if (takes(cost)) return -1;
    }
    for (const char* worth : {" is worth", " are worth"}) {
      if (takes(worth)) return 1;
    }
    return std::nullopt;
  }

  // "2 steps", with "plus what 2 steps cost"; without a verb, what it is to the robot.
  IntegerVector side() {
    auto things = list();
    const auto own = verb();
    auto sum = scaled(things, own ? *own : sign_of(things));
    if (takes(" plus what ")) {
      things = list();
      const auto other = verb();
      if (!other) is_understood_ = false;
      sum += scaled(things, other.value_or(1));
    }
    return sum;
  }

  [[nodiscard]] int sign_of(const IntegerVector& things) const {
    for (std::size_t k = 0; k < things.size(); ++k) {
      if (things[k] != 0) return (domain_.weights().integer[k] < 0) == (things[k] > 0) ? -1 : 1;
    }
    return 1;
  }

  static IntegerVector scaled(const IntegerVector& v, std::int64_t n) {
    IntegerVector result = v;
    for (std::size_t k = 0; k < v.size(); ++k) result[k] *= n;
    return result;
  }

  IntegerVector inequality() {
    const auto first = list();
    for (const char* better : {" is better than ", " are better than "}) {
      if (takes(better)) return first - list();
    }
    const auto sign = verb();
    if (!sign) {
      is_understood_ = false;
      return first;
    }
    const auto subject = scaled(first, *sign);
    if (takes(" something") || takes(" nothing or more")) return subject;
    if (takes(" less than nothing") || takes(" at most nothing")) return scaled(subject, -1);
    if (takes(" more than ") || takes(" at least as much as ")) return subject - side();
    if (takes(" less than ") || takes(" no more than ") || takes(" at most as much as ")) return side() - subject;
    is_understood_ = false;
    return subject;
  }

  const Domain& domain_;
  std::string text_;
  std::size_t at_ = 0;
  bool is_understood_ = true;
  std::optional<IntegerVector> condition_;
  IntegerVector said_;
};

}  // namespace kith::testing
