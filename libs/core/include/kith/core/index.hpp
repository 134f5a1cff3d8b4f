#pragma once

#include <compare>
#include <cstddef>
#include <functional>

namespace kith {

/// A position in a collection of `Tag`s. Indices of different tags do not mix,
/// and nothing converts to one by itself. A look-up that fails returns
/// std::optional, never an index that points nowhere.
template <typename Tag>
class Index {
 public:
  constexpr Index() = default;
  explicit constexpr Index(std::size_t value) noexcept : value_{value} {}
  [[nodiscard]] constexpr std::size_t value() const noexcept { return value_; }
  constexpr Index& operator++() noexcept { return ++value_, *this; }
  friend constexpr auto operator<=>(Index, Index) = default;

 private:
  std::size_t value_ = 0;
};

}  // namespace kith

template <typename Tag>
struct std::hash<kith::Index<Tag>> {
  std::size_t operator()(kith::Index<Tag> index) const noexcept { return std::hash<std::size_t>{}(index.value()); }
};
