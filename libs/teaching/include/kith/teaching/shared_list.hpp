#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

namespace kith {

/// A list that only grows. A value whose copies share the elements, which never change: many sessions that look ahead
/// from one have its past in common.
template <typename T>
class SharedList {
  using Shared = std::vector<std::shared_ptr<const T>>;

 public:
  class Iterator {
   public:
    using iterator_category = std::bidirectional_iterator_tag;
    using value_type = T;
    using difference_type = std::ptrdiff_t;
    using pointer = const T*;
    using reference = const T&;

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
    friend class SharedList;
    explicit Iterator(typename Shared::const_iterator at) noexcept : at_{at} {}
    typename Shared::const_iterator at_{};
  };

  [[nodiscard]] bool empty() const noexcept { return elements_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return elements_.size(); }
  [[nodiscard]] Iterator begin() const noexcept { return Iterator{elements_.begin()}; }
  [[nodiscard]] Iterator end() const noexcept { return Iterator{elements_.end()}; }
  /// @pre !empty()
  [[nodiscard]] const T& front() const noexcept { return *elements_.front(); }
  [[nodiscard]] const T& back() const noexcept { return *elements_.back(); }
  /// @pre i < size()
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return *elements_[i]; }

  /// @pre element is not null
  void push_back(std::shared_ptr<const T> element) { elements_.push_back(std::move(element)); }
  /// So that the next push_back() cannot fail.
  void make_room() {
    if (elements_.size() == elements_.capacity()) elements_.reserve(2 * elements_.size() + 8);
  }

  /// An element for push_back(), which then cannot fail.
  [[nodiscard]] std::shared_ptr<const T> prepare(T element) {
    make_room();
    return std::make_shared<const T>(std::move(element));
  }

  /// Whether the elements are equal, shared or not.
  friend bool operator==(const SharedList& a, const SharedList& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
  }

 private:
  Shared elements_;
};

}  // namespace kith
