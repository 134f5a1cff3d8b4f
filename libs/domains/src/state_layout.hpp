#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "kith/domains/family_map.hpp"

namespace kith::detail {

// A state in one word: where the robot and the items are (cell numbers), which
// item is carried, which stations are left, whether the robot has gone.
using PackedState = std::uint64_t;

class StateLayout {
 public:
  StateLayout() = default;
  explicit StateLayout(const FamilyMap& family_map)
      : cell_bits_{static_cast<unsigned>(std::bit_width(family_map.num_cells() - 1))},
        num_items_{static_cast<unsigned>(family_map.items.size())},
        num_stations_{static_cast<unsigned>(family_map.stations.size())},
        carried_bits_{static_cast<unsigned>(std::bit_width(family_map.items.size()))} {}

  // More than 64: the world is too large for a word.
  [[nodiscard]] std::size_t num_bits() const {
    return std::size_t{cell_bits_} * (1 + std::size_t{num_items_}) + carried_bits_ + num_stations_ + 1;
  }

  [[nodiscard]] std::size_t robot(PackedState s) const { return field(s, 0, cell_bits_); }
  [[nodiscard]] std::size_t item(PackedState s, std::size_t i) const { return field(s, item_at(i), cell_bits_); }
  // 0: none, i + 1: item i.
  [[nodiscard]] std::size_t carried(PackedState s) const { return field(s, carried_at(), carried_bits_); }
  [[nodiscard]] std::uint64_t stations(PackedState s) const { return field(s, stations_at(), num_stations_); }
  [[nodiscard]] bool has_station(PackedState s, std::size_t i) const { return (stations(s) >> i & 1U) != 0; }
  [[nodiscard]] bool exited(PackedState s) const { return field(s, exited_at(), 1) != 0; }

  [[nodiscard]] PackedState with_robot(PackedState s, std::size_t cell) const { return set(s, 0, cell_bits_, cell); }
  [[nodiscard]] PackedState with_item(PackedState s, std::size_t i, std::size_t cell) const {
    return set(s, item_at(i), cell_bits_, cell);
  }
  [[nodiscard]] PackedState with_carried(PackedState s, std::size_t value) const {
    return set(s, carried_at(), carried_bits_, value);
  }
  [[nodiscard]] PackedState with_stations(PackedState s, std::uint64_t mask) const {
    return set(s, stations_at(), num_stations_, mask);
  }
  [[nodiscard]] PackedState with_exit(PackedState s) const { return set(s, exited_at(), 1, 1); }

 private:
  [[nodiscard]] unsigned item_at(std::size_t i) const { return cell_bits_ * (1U + static_cast<unsigned>(i)); }
  [[nodiscard]] unsigned carried_at() const { return cell_bits_ * (1U + num_items_); }
  [[nodiscard]] unsigned stations_at() const { return carried_at() + carried_bits_; }
  [[nodiscard]] unsigned exited_at() const { return stations_at() + num_stations_; }

  static constexpr std::uint64_t ones(unsigned bits) { return (std::uint64_t{1} << bits) - 1; }
  static constexpr std::uint64_t field(PackedState s, unsigned at, unsigned bits) { return s >> at & ones(bits); }
  static constexpr PackedState set(PackedState s, unsigned at, unsigned bits, std::uint64_t value) {
    return (s & ~(ones(bits) << at)) | value << at;
  }

  unsigned cell_bits_ = 0;
  unsigned num_items_ = 0;
  unsigned num_stations_ = 0;
  unsigned carried_bits_ = 0;
};

}  // namespace kith::detail
