#include <algorithm>

#include "mutate.hpp"

namespace kith::fuzzing {
namespace {

// Bytes at which something changes: zero, the ends of ranges, what separates.
constexpr std::string_view kOddBytes{"\x00\x01\x02\x7F\x80\x81\xFE\xFF\n,\"", 11};

std::string with_range_moved(std::string bytes, Dice& dice) {
  const auto from = dice.below(bytes.size());
  const auto count = 1 + dice.below(bytes.size() - from);
  const auto part = bytes.substr(from, count);
  const auto to = dice.below(bytes.size() + 1);
  switch (dice.below(3)) {
    case 0:
      return bytes.erase(from, count);
    case 1:
      return bytes.insert(to, part);
    default:
      return bytes.replace(to, std::min(count, bytes.size() - to), part);
  }
}

}  // namespace

std::string mutate_bytes(std::string_view bytes, Dice& dice) {
  std::string result{bytes};
  if (result.empty()) return std::string(1, static_cast<char>(dice.below(256)));
  const auto at = dice.below(result.size());
  switch (dice.below(6)) {
    case 0:
      result[at] = static_cast<char>(result[at] ^ (1 << dice.below(8)));
      return result;
    case 1:
      result[at] = dice.pick(kOddBytes);
      return result;
    case 2:
      result[at] = static_cast<char>(result[at] + (dice.one_in(2) ? 1 : -1));
      return result;
    case 3:
      return result.insert(at, 1, static_cast<char>(dice.below(256)));
    case 4:
      return result.erase(at, 1);
    default:
      return with_range_moved(std::move(result), dice);
  }
}

std::string mutate_vectors(std::string_view bytes, std::size_t head, std::size_t width, Dice& dice) {
  std::string result{bytes};
  if (width == 0 || result.size() < head + width || dice.one_in(4)) return mutate_bytes(bytes, dice);
  const auto rows = (result.size() - head) / width;
  const auto row = [&] { return head + dice.below(rows) * width; };
  const auto a = row();
  const auto b = row();
  switch (dice.below(6)) {
    case 0:
      return result.erase(a, width);
    case 1:
      return result.insert(b, result.substr(a, width));
    case 2:
      if (a == b) return result;
      std::swap_ranges(result.begin() + static_cast<std::ptrdiff_t>(a),
                       result.begin() + static_cast<std::ptrdiff_t>(a + width),
                       result.begin() + static_cast<std::ptrdiff_t>(b));
      return result;
    case 3:  // a row that is nearly another
      result.insert(b, result.substr(a, width));
      result[b + dice.below(width)] = static_cast<char>(dice.below(256));
      return result;
    case 4:  // numbers of a row exchanged
      std::swap(result[a + dice.below(width)], result[a + dice.below(width)]);
      return result;
    default:
      result[a + dice.below(width)] = static_cast<char>(dice.below(256));
      return result;
  }
}

}  // namespace kith::fuzzing
