#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fault_case.hpp"

namespace kith::faults {

/// Counts what cases came to, per scenario and family.
class Summary {
 public:
  void add(const Case& one, const Outcome& outcome);

  [[nodiscard]] std::size_t num_cases() const { return all_.cases; }
  [[nodiscard]] std::size_t num_wrong() const { return all_.wrong; }
  /// A table, a line per scenario and family.
  [[nodiscard]] std::string text() const;

 private:
  struct Row {
    std::size_t cases = 0, struck = 0, resumed = 0, refused = 0, with_loss = 0, lost = 0, wrong = 0;
    void add(const Outcome& outcome);
  };

  std::map<std::pair<std::string, std::string>, Row> rows_;
  Row all_;
};

}  // namespace kith::faults
