#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "kith/domains/model_text.hpp"

namespace kith::detail {

// Names numbered in the order in which they come.
class Names {
 public:
  Names() = default;
  explicit Names(const std::vector<std::string>& names) {
    for (const std::string& name : names) (void)number_of(name);
  }
  // The number of the name, which is added if it is new.
  std::uint32_t number_of(const std::string& name) {
    const auto [at, is_new] = numbers_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(name);
    return at->second;
  }
  [[nodiscard]] std::optional<std::uint32_t> find(const std::string& name) const {
    const auto at = numbers_.find(name);
    return at == numbers_.end() ? std::nullopt : std::optional{at->second};
  }
  [[nodiscard]] const std::vector<std::string>& all() const { return names_; }
  [[nodiscard]] std::size_t size() const { return names_.size(); }

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
};

// Distinct feature vectors, numbered in the order in which they come.
class FeatureRows {
 public:
  std::uint32_t number_of(const std::vector<double>& features) {
    const auto [at, is_new] = numbers_.try_emplace(features, static_cast<std::uint32_t>(rows_.size()));
    if (is_new) rows_.push_back(features);
    return at->second;
  }
  [[nodiscard]] const std::vector<double>& row(std::uint32_t number) const { return rows_[number]; }
  [[nodiscard]] std::size_t size() const { return rows_.size(); }

 private:
  std::map<std::vector<double>, std::uint32_t> numbers_;
  std::vector<std::vector<double>> rows_;
};

// A state as a file has it.
struct RawState {
  std::string key;   // what transitions call it
  std::string name;  // what people call it
  bool terminal = false;
  bool start = false;
  bool initial = false;
  ModelPlace place;
};

// One possible outcome of an action, as a file has it. Offsets are into RawMdp::file.
struct RawTransition {
  std::uint32_t state = 0;
  std::uint32_t action = 0;
  std::uint32_t next = 0;
  std::uint32_t features = 0;  // row of RawModel::features
  double probability = 1.0;
  std::uint32_t at = 0;              // where it begins
  std::uint32_t probability_at = 0;  // where its probability stands; the same as `at` if it is not written
};

struct RawMdp {
  std::string name;
  const ModelText* file = nullptr;  // with the transitions
  ModelPlace place;
  std::vector<RawState> states;
  std::vector<std::int32_t> variables;  // row-major, shape [states, variables of the model]
  std::vector<RawTransition> transitions;
};

// What the files of a model say, before it is checked.
struct RawModel {
  const ModelText* last_file = nullptr;  // that was opened for it
  std::vector<std::string> variables;    // integer variables that states have
  Names actions;
  bool actions_are_declared = false;  // by the domain file: no others may come
  FeatureRows features;
  std::vector<RawMdp> mdps;
  std::size_t num_transitions = 0;  // of all of them

  void add(RawMdp& mdp, const RawTransition& transition) {
    mdp.transitions.push_back(transition);
    ++num_transitions;
  }
};

}  // namespace kith::detail
