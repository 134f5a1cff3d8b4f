#pragma once

#include <string>
#include <vector>

#include "kith/domains/domain.hpp"

namespace kith {

/// Layouts in which other programs read an MDP.
enum class ModelFormat {
  kDrn,        ///< Storm's DRN: one reward model per feature, and "reward" with the robot's weights.
  kPrism,      ///< PRISM's explicit files: .tra, .sta, .lab and a .trew per feature; kith reads them too.
  kCassandra,  ///< Cassandra's MDP format (pomdp.org), with the robot's rewards.
  kGymJson,    ///< Gymnasium's P[s][a] as JSON, with the robot's rewards, and beside it "phi", the features.
};

/// "drn", "prism", "cassandra", "gym-json": the names of the formats in the order of ModelFormat.
[[nodiscard]] const std::vector<std::string>& model_format_names();

/// A file of an export.
struct ExportedFile {
  std::string name;
  std::string text;
};

/// MDP `m` in another program's format, states in kith's order (terminal ones last), rewards with the weights as
/// written in the domain file. PRISM's files and those of Gymnasium come with a domain file (.toml) that reads them
/// again.
///
/// Terminal states stay where they are for nothing. DRN has rewards of actions only: there a feature is expected over
/// the outcomes. In Cassandra's and Gymnasium's format every action exists in every state: one that the robot does not
/// have there stays where it is at a loss that never pays. Discounts are in no DRN or PRISM file; a comment says them.
/// @param name  of the file, or with kPrism what the names of all files begin with; without a folder.
/// @throws std::invalid_argument if there is no such MDP.
[[nodiscard]] std::vector<ExportedFile> export_mdp(const Domain& domain, MdpIndex m, ModelFormat format,
                                                   const std::string& name);

}  // namespace kith
