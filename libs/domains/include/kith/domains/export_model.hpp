#pragma once

#include <string>
#include <vector>

#include "kith/domains/domain.hpp"

namespace kith {

/// Layouts in which other programs read an MDP.
enum class ModelFormat {
  kPrism,    ///< PRISM's explicit files: .tra, .sta, .lab and a .trew per feature.
  kGymJson,  ///< Gymnasium's P[s][a] as JSON, with the robot's rewards, and beside it "phi", the features.
};

/// "prism", "gym-json": the names of the formats in the order of ModelFormat.
[[nodiscard]] const std::vector<std::string>& model_format_names();

/// A file of an export.
struct ExportedFile {
  std::string name;
  std::string text;
};

/// MDP `m` in another program's format, states in kith's order (terminal ones last), rewards with the weights as
/// written in the domain file. A domain file (.toml) that reads them again comes with them.
///
/// Terminal states stay where they are for nothing. In Gymnasium's format every action exists in every state: one that
/// the robot does not have there stays where it is at a loss that never pays. PRISM's files have no discount; the
/// domain file says it.
/// @param name  of the file, or with kPrism what the names of all files begin with; without a folder.
/// @throws std::invalid_argument if there is no such MDP.
[[nodiscard]] std::vector<ExportedFile> export_mdp(const Domain& domain, MdpIndex m, ModelFormat format,
                                                   const std::string& name);

}  // namespace kith
