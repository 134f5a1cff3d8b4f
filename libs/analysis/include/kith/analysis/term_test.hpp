#pragma once

#include <cstddef>
#include <string>

#include "kith/analysis/estimable.hpp"
#include "kith/analysis/tests.hpp"

namespace kith {

/// The test of a term of a model: that none of its effects differs from 0.
struct TermTest {
  std::string name;    ///< "strategy:composition"
  std::size_t df = 0;  ///< Of the numerator: what the term adds to the model without it.
  Estimable<TestResult> test = Estimable<TestResult>::impossible("not computed");
};

}  // namespace kith
