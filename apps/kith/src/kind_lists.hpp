#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "console.hpp"
#include "kith/core/parameter.hpp"

namespace kith::cli {

/// The rows of one registry, as people read them.
struct KindList {
  struct Row {
    std::string_view name;
    std::string_view description;
    std::span<const Parameter> parameters;
  };
  std::string_view topic;  ///< "learners": what `kith explain` takes.
  std::string_view key;    ///< Which key of a study file names a row: "learner.X.kind".
  std::vector<Row> rows;
};

/// All registries whose rows study files name: learner models, strategies, beliefs about the team, stop rules.
[[nodiscard]] std::vector<KindList> kind_lists();

/// Every row with its parameters: name, type, range, default, meaning, source.
[[nodiscard]] std::string to_text(const KindList& list, const Console& console);
/// The names of the rows and of their parameters alone, for the help of commands that take keys of a study.
[[nodiscard]] std::string keys_text();

}  // namespace kith::cli
