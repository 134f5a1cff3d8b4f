#include "kith/live/screening.hpp"

#include <stdexcept>

namespace kith {

double screening_estimate(std::size_t right, std::size_t tests) {
  if (right > tests) throw std::invalid_argument{"screening_estimate: more right answers than tests"};
  return (static_cast<double>(right) + 1.0) / (static_cast<double>(tests) + 2.0);
}

}  // namespace kith
