#pragma once

#include <optional>

#include "dynamics.hpp"
#include "explicit_family.hpp"
#include "kith/domains/named_files.hpp"
#include "kith/files/reader.hpp"
#include "model_drawing.hpp"

namespace kith::detail {

// What a domain file and the files that it names say about an explicit model.
struct ModelReading {
  Dynamics dynamics;  // discount, max_steps and features; no actions, atoms or rules
  RawModel model;
  std::optional<DrawingPlan> drawing;
};

// Reads [mdp], [model] with its drawing, [map] and [[feature]], and the files.
[[nodiscard]] ModelReading read_model(TomlReader& file, NamedFiles& files, ModelReport& report);

}  // namespace kith::detail
