#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "models.hpp"
#include "scenario.hpp"

namespace kith::faults {

/// What became of the commands of a scenario after a fault.
struct Recovered {
  bool refused = false;  ///< One refused and named what to add, with which it finished.
  int lost = 0;          ///< Teams that had been saved and were taught again.
  std::string wrong{};   ///< Empty if all is well.
};

/// Gives the commands of a scenario again, without a fault, and checks that they finish, with the tables of an
/// undisturbed run, having taken up every record that can be read.
class Recovery {
 public:
  Recovery(const Scenario& scenario, const Models& models, std::filesystem::path root);

  /// Counts what is saved in the folder before the fault.
  void look();
  /// This journal is damaged: messages have to say what that costs.
  void require_names(const std::string& journal) { damaged_ = journal; }
  /// `may_refuse`: whether a command may refuse at first if it names the way out; `is_mixed`: what is there may be
  /// foreign, and then need not be taken up. @throws kith::Error
  [[nodiscard]] Recovered run(bool may_refuse, bool is_mixed, bool verifies);

 private:
  void persist(Words words, bool may_refuse, bool is_mixed);
  void check_teams(const Words& words, const std::string& folder, std::size_t readable, const std::string& messages);

  const Scenario& scenario_;
  const Models& models_;
  std::filesystem::path root_;
  std::map<std::string, std::size_t> saved_;  // by folder
  std::string damaged_;
  Recovered result_;
};

}  // namespace kith::faults
