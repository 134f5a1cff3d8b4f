#include "fault_case.hpp"

#include <sstream>

namespace kith::faults {

std::string to_text(const Case& one) {
  return one.scenario + " " + std::to_string(one.variant) + " " + one.family + " " + one.fault;
}

std::optional<Case> parse_case(const std::string& text) {
  std::istringstream words{text};
  Case one;
  if (!(words >> one.scenario >> one.variant >> one.family >> one.fault) || one.variant < 0) return std::nullopt;
  return one;
}

Variant variant_of(int number) { return {number / 4, 1 + number % 2, number % 4 < 2}; }

int number_of(const Variant& variant) { return variant.preparation * 4 + (variant.each ? 0 : 2) + variant.threads - 1; }

}  // namespace kith::faults
