#include "kith/fit/person_log.hpp"

namespace kith {
namespace {

void add(std::string& text, const std::vector<HalfSpace>& half_spaces) {
  for (const auto& half_space : half_spaces) text += to_string(half_space.normal());
  text += ';';
}

}  // namespace

std::string lessons_of(const PersonLog& person) {
  std::string text;
  for (const auto& period : person.periods) {
    text += std::to_string(period.component) + (period.feedback ? '!' : '.');
    add(text, period.conveyed);
    add(text, period.taught);
  }
  return text;
}

}  // namespace kith
