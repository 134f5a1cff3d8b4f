#pragma once

#include <map>
#include <string>
#include <vector>

#include "run_files.hpp"

namespace kith::detail {

// How the teams of a run are compared: a series is a strategy, in a study that varies keys a strategy at one setting; a
// cell is a series and a composition. Both in the order of the tables.
struct ReportDesign {
  struct Series {
    std::string code;   // "joint", or "joint [teacher.process_noise=0.5]"
    std::string label;  // "Joint"
    std::string strategy = "common";
    std::size_t variant = 0;
    std::map<char, std::size_t> people;  // by type
  };
  struct Cell {
    std::size_t series = 0;
    std::string composition;
    std::size_t teams = 0;
  };
  std::vector<Series> series;
  std::vector<Cell> cells;
  std::vector<std::size_t> cell_of_team;  // by position in the tables
  std::size_t people = 0;
};
[[nodiscard]] ReportDesign design_of(const RunFiles& run);

// "individual-low" -> "Individual low".
[[nodiscard]] std::string label_of(std::string_view code);

}  // namespace kith::detail
