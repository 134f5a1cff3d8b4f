#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/domains/export_model.hpp"

namespace kith::detail {

// One outcome of an action; those that lead to the same state are one, with the expectation of their features.
struct ExportedOutcome {
  std::size_t next = 0;
  double probability = 0.0;
  std::vector<double> features;
  double reward = 0.0;  // weights . features
};

struct ExportedChoice {
  std::size_t action = 0;
  std::vector<ExportedOutcome> outcomes;  // by next state
};

// What all formats say of an MDP.
class ExportView {
 public:
  ExportView(const Domain& domain, MdpIndex m) : domain_{domain}, m_{m}, mdp_{domain.mdp(m)} {}

  [[nodiscard]] const Domain& domain() const { return domain_; }
  [[nodiscard]] const Mdp& mdp() const { return mdp_; }
  [[nodiscard]] MdpIndex number() const { return m_; }
  [[nodiscard]] std::size_t num_states() const { return mdp_.num_states() + mdp_.num_terminals(); }
  [[nodiscard]] bool is_terminal(std::size_t s) const { return mdp_.is_terminal(StateIndex{s}); }
  [[nodiscard]] bool is_start(std::size_t s) const;
  [[nodiscard]] std::size_t initial() const { return domain_.initial_state(m_).value(); }
  [[nodiscard]] std::string state_name(std::size_t s) const { return domain_.state_name(m_, StateIndex{s}); }
  // In action order; none in terminal states.
  [[nodiscard]] std::vector<ExportedChoice> choices(std::size_t s) const;
  // A reward so low that staying for it never pays.
  [[nodiscard]] double loss() const;
  // "id", or "id, MDP 3 (wet)".
  [[nodiscard]] std::string title() const;

 private:
  const Domain& domain_;
  MdpIndex m_;
  const Mdp& mdp_;
};

// The shortest text that reads back to the same number.
[[nodiscard]] std::string number_text(double number);
// The same without an exponent and with a decimal point.
[[nodiscard]] std::string decimal_text(double number);
// The texts with everything but letters, digits, '_' and '-' replaced by '_'; where that makes equal ones, numbered.
[[nodiscard]] std::vector<std::string> plain_names(const std::vector<std::string>& names);

[[nodiscard]] std::string gym_text(const ExportView& view);
[[nodiscard]] std::vector<ExportedFile> prism_files(const ExportView& view, const std::string& name);

// A domain file whose [model] is `model`, for the actions by these names.
[[nodiscard]] std::string domain_text(const ExportView& view, const std::vector<std::string>& actions,
                                      const std::string& model);

}  // namespace kith::detail
