#include "kith/domains/export_model.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "export_view.hpp"
#include "kith/toml/document.hpp"

namespace kith {
namespace detail {

bool ExportView::is_start(std::size_t s) const {
  const auto& starts = domain_.starts(m_);
  return std::binary_search(starts.begin(), starts.end(), StateIndex{s});
}

std::vector<ExportedChoice> ExportView::choices(std::size_t s) const {
  std::vector<ExportedChoice> result;
  if (is_terminal(s)) return result;
  const std::vector<double>& weights = domain_.weights().raw;
  for (const Choice& choice : mdp_.choices(StateIndex{s})) {
    // Outcomes with the same next state are one; its features are those to be expected.
    std::map<std::size_t, ExportedOutcome> merged;
    for (const Outcome& outcome : mdp_.outcomes(choice)) {
      ExportedOutcome& one = merged[outcome.next.value()];
      const auto features = mdp_.features(outcome);
      if (one.features.empty()) one.features.assign(features.size(), 0.0);
      const double sum = one.probability + outcome.probability;
      for (std::size_t k = 0; k < features.size(); ++k) {
        one.features[k] = (one.probability * one.features[k] + outcome.probability * features[k]) / sum;
      }
      one.next = outcome.next.value();
      one.probability += outcome.probability;
    }

    ExportedChoice exported{choice.action.value(), {}};
    for (auto& [next, one] : merged) {
      for (std::size_t k = 0; k < weights.size(); ++k) one.reward += weights[k] * one.features[k];
      exported.outcomes.push_back(std::move(one));
    }
    result.push_back(std::move(exported));
  }
  return result;
}

// Nothing earns less per step than -largest, so whoever stays for less than -2 * largest - 1 could only have lost.
double ExportView::loss() const {
  const std::vector<double>& weights = domain_.weights().raw;
  double largest = 0.0;
  for (std::size_t row = 0; row < mdp_.num_feature_rows(); ++row) {
    double reward = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) reward += weights[k] * mdp_.feature_row(row)[k];
    largest = std::max(largest, std::abs(reward));
  }
  return -2.0 * std::ceil(largest) - 1.0;
}

std::string ExportView::title() const {
  if (domain_.num_mdps() == 1) return domain_.id();
  const std::string name = domain_.describe_world(m_);
  return domain_.id() + ", world " + std::to_string(m_.value()) + (name.empty() ? "" : " (" + name + ")");
}

std::string number_text(double number) {
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  return {buffer.data(), end};
}

std::string decimal_text(double number) {
  std::array<char, 512> buffer{};  // as many digits as the smallest number has
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number, std::chars_format::fixed).ptr;
  std::string text{buffer.data(), end};
  return text.find('.') == std::string::npos ? text + ".0" : text;
}

std::vector<std::string> plain_names(const std::vector<std::string>& names) {
  std::vector<std::string> plain;
  for (std::string one : names) {
    for (char& c : one) {
      const bool keep =
          (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
      if (!keep) c = '_';
    }
    if (one.empty()) one = "_";
    if (std::find(plain.begin(), plain.end(), one) != plain.end()) one += "_" + std::to_string(plain.size());
    plain.push_back(std::move(one));
  }
  return plain;
}

namespace {

std::string quoted(const std::string& text) { return to_toml(TomlValue{text}); }

std::string half_spaces_text(const Domain& domain) {
  std::string text;
  for (const HalfSpace& half_space : domain.prior()) {
    std::string normal;
    for (std::size_t k = 0; k < domain.num_features(); ++k) {
      if (half_space.normal()[k] == 0) continue;
      normal += (normal.empty() ? "" : ", ") + quoted(domain.feature_names()[k]) + " = " +
                std::to_string(half_space.normal()[k]);
    }
    text += (text.empty() ? "" : ", ") + std::string{"{ "} + normal + " }";
  }
  return text;
}

}  // namespace

std::string domain_text(const ExportView& view, const std::vector<std::string>& actions, const std::string& model) {
  const Domain& domain = view.domain();
  std::string names;
  for (const std::string& action : actions) names += (names.empty() ? "" : ", ") + quoted(action);
  std::string text = "schema = \"kith.domain/1\"\nid = " + quoted(domain.id()) + "\ntitle = " + quoted(domain.title()) +
                     (domain.goal().empty() ? "" : "\ngoal = " + quoted(domain.goal())) +
                     "\n\n[mdp]\ndiscount = " + decimal_text(view.mdp().discount()) +
                     "\nmax_steps = " + std::to_string(domain.max_steps()) + "\nactions = [" + names + "]\n\n" + model;
  std::string weights;
  std::string words;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const std::string name = quoted(domain.feature_names()[k]);
    text += "\n[[feature]]\nname = " + name + "\n";
    weights += (k == 0 ? "" : ", ") + name + " = " + decimal_text(domain.weights().raw[k]);
    words += name + " = " + quoted(domain.feature_words(k)) + "\n";
  }
  text += "\n[reward]\nweights = { " + weights + " }\n";
  if (domain.weights().norm == WeightNorm::kL1) text += "normalize = \"l1\"\n";
  if (!domain.prior().empty()) text += "\n[prior]\nhalfspaces = [ " + half_spaces_text(domain) + " ]\n";
  return text + "\n[words]\n" + words;
}

}  // namespace detail

const std::vector<std::string>& model_format_names() {
  static const std::vector<std::string> kNames{"prism", "gym-json"};
  return kNames;
}

std::vector<ExportedFile> export_mdp(const Domain& domain, MdpIndex m, ModelFormat format, const std::string& name) {
  const detail::ExportView view{domain, m};
  if (format == ModelFormat::kPrism) return detail::prism_files(view, name);
  const std::string model = "[model]\nformat = \"gym-json\"\n[[model.mdp]]\nfile = " + to_toml(TomlValue{name}) + "\n";
  const std::string stem = name.ends_with(".json") ? name.substr(0, name.size() - 5) : name;
  return {{name, detail::gym_text(view)}, {stem + ".toml", detail::domain_text(view, domain.action_names(), model)}};
}

}  // namespace kith
