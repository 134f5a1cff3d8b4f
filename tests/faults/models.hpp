#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "folders.hpp"
#include "journals.hpp"
#include "process.hpp"

namespace kith::faults {

/// The programs.
struct Tools {
  std::filesystem::path program{};  ///< kith
  std::filesystem::path shim{};     ///< The library that makes calls fail.
  std::filesystem::path mpirun{};   ///< Empty where there is none.
};

/// Runs kith with these arguments in a folder.
[[nodiscard]] Ended run_kith(const Tools& tools, const std::filesystem::path& folder, const Words& arguments,
                             const Environment& environment = {});

/// All that an undisturbed run leaves behind and that is read from it, without what may differ, such as dates.
struct Expected {
  Files tables{}, inputs{};
  nlohmann::json manifest{}, report{};
  std::string analysis{}, page{};
};

/// manifest.json without times, machine and program; null if the text is no JSON.
[[nodiscard]] nlohmann::json comparable_manifest(const std::string& text);
/// What `kith report --json` prints, without times and notes; null if the text is no JSON.
[[nodiscard]] nlohmann::json comparable_report(const std::string& text);
/// The text with every date and time replaced.
[[nodiscard]] std::string without_dates(std::string text);

/// Folders as undisturbed or simply killed runs leave them, made once and copied for every case.
///
/// Of the study: finished, unfinished-1, -3 and -6 (so many of eight teams), untabled (all teams, no tables), replaced
/// (finished, where another study was before), s1 to s3 (shards), s1-unfinished, half-2 (shard 2/2), merged. Of other
/// studies, which differ in seed, in the order of strategies or in another key: seed.finished, seed.unfinished,
/// seed.s1 and so on.
class Models {
 public:
  /// Makes them all. @throws kith::Error if the program fails, or does not say what the checks need.
  Models(Tools tools, std::filesystem::path scratch);

  [[nodiscard]] const Tools& tools() const { return tools_; }
  [[nodiscard]] std::filesystem::path folder(const std::string& model) const { return scratch_ / "models" / model; }
  [[nodiscard]] std::vector<std::string> names() const;
  /// What is to be expected of a finished model; nullptr for others.
  [[nodiscard]] const Expected* expected_of(const std::string& model) const;
  [[nodiscard]] const Expected& expected() const { return expected_.at("finished"); }
  /// The records that belong into the journal of the folder of this name: run, s1, s2 or s3.
  [[nodiscard]] const Records& records_of(const std::string& name) const { return records_.at(name); }
  /// The model's journal, damaged in ways that leave some but not all of its records readable.
  [[nodiscard]] const std::vector<std::string>& damaged_journals(const std::string& model) const {
    return damaged_.at(model);
  }

 private:
  void make(const std::string& model, const std::string& name, const std::vector<Words>& commands,
            const Environment& environment = {});
  void make_study();
  void make_other(const std::string& name, const Words& options);
  void expect(const std::string& model);
  void damage_journal(const std::string& model);
  void check_messages();

  Tools tools_;
  std::filesystem::path scratch_;
  std::map<std::string, Expected> expected_;
  std::map<std::string, std::vector<std::string>> damaged_;
  std::map<std::string, Records> records_;
};

/// How many teams a study says it found done when it began.
[[nodiscard]] int teams_taken_up(const std::string& messages);

}  // namespace kith::faults
