#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "kith/teaching/lesson.hpp"

namespace kith {

/// A completed interaction period.
struct PastPeriod {
  Lesson lesson;
  std::vector<std::vector<Answer>> answers;  ///< Per member, per test; empty for a member who was away.
  Feedback feedback;
  friend bool operator==(const PastPeriod&, const PastPeriod&) = default;
};

/// All completed periods of a session, the first one first. A value whose copies share the periods, which never change:
/// many sessions that look ahead from one have its past in common.
class PastPeriods {
  using Shared = std::vector<std::shared_ptr<const PastPeriod>>;

 public:
  class Iterator {
   public:
    using iterator_category = std::bidirectional_iterator_tag;
    using value_type = PastPeriod;
    using difference_type = std::ptrdiff_t;
    using pointer = const PastPeriod*;
    using reference = const PastPeriod&;

    Iterator() = default;
    reference operator*() const noexcept { return **at_; }
    pointer operator->() const noexcept { return at_->get(); }
    Iterator& operator++() noexcept {
      ++at_;
      return *this;
    }
    Iterator operator++(int) noexcept { return Iterator{at_++}; }
    Iterator& operator--() noexcept {
      --at_;
      return *this;
    }
    Iterator operator--(int) noexcept { return Iterator{at_--}; }
    friend bool operator==(const Iterator&, const Iterator&) = default;

   private:
    friend class PastPeriods;
    explicit Iterator(Shared::const_iterator at) noexcept : at_{at} {}
    Shared::const_iterator at_{};
  };

  [[nodiscard]] bool empty() const noexcept { return periods_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return periods_.size(); }
  [[nodiscard]] Iterator begin() const noexcept { return Iterator{periods_.begin()}; }
  [[nodiscard]] Iterator end() const noexcept { return Iterator{periods_.end()}; }
  /// @pre !empty()
  [[nodiscard]] const PastPeriod& front() const noexcept { return *periods_.front(); }
  [[nodiscard]] const PastPeriod& back() const noexcept { return *periods_.back(); }
  /// @pre i < size()
  [[nodiscard]] const PastPeriod& operator[](std::size_t i) const noexcept { return *periods_[i]; }

  /// @pre period is not null
  void push_back(std::shared_ptr<const PastPeriod> period) { periods_.push_back(std::move(period)); }
  /// So that the next push_back() cannot fail.
  void make_room() {
    if (periods_.size() == periods_.capacity()) periods_.reserve(2 * periods_.size() + 8);
  }

  /// Whether the periods are equal, shared or not.
  friend bool operator==(const PastPeriods& a, const PastPeriods& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
  }

 private:
  Shared periods_;
};

}  // namespace kith
