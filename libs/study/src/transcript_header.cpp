#include <fmt/format.h>

#include "kith/explain/legend.hpp"
#include "kith/explain/words.hpp"
#include "kith/explain/wrapped.hpp"
#include "kith/study/transcript.hpp"

namespace kith {
namespace {

// What a reader must know before the first period.
class HeaderWriter {
 public:
  HeaderWriter(const Atlas& atlas, const Transcript& transcript)
      : atlas_{atlas}, domain_{atlas.domain()}, transcript_{transcript} {}

  std::string text() {
    header();
    return std::move(out_);
  }

 private:
  void line(const std::string& text = "") { out_ += wrapped_line(text) + "\n"; }

  void header() {
    const auto& address = transcript_.address;
    const auto& spec = transcript_.spec;
    line(fmt::format("{}: teaching {} by strategy {}", domain_.id(), address.composition, address.strategy));
    line(fmt::format("study {}, seed address {}", spec.id, transcript_.record.seed_address));
    for (const auto& factor : spec.factors) line("  " + factor.key + " = " + factor.value);
    reward();
    pictures();
    learners();
  }

  void reward() {
    line();
    line("The robot's reward (all values use unit-length weights):");
    line(fmt::format("  {:<10} {:>6} {:>12}", "", "raw", "unit length"));
    for (std::size_t k = 0; k < domain_.num_features(); ++k) {
      IntegerVector once(domain_.num_features());
      once[k] = 1;
      line(fmt::format("  {:<10} {:>6} {:>12.4f} for {}", domain_.feature_names()[k], domain_.weights().raw[k],
                       domain_.weights().return_of(once), domain_.feature_words(k)));
    }
    if (const auto explained = explained_in_words(domain_); !explained.empty()) line("Note: " + explained + ".");
    line("What determines its policy, and is to be learned:");
    for (const auto& half_space : atlas_.policy_bec_half_spaces()) line("  " + described(domain_, half_space));
    for (const auto& half_space : domain_.prior())
      line("  " + described(domain_, half_space) + " (known to everybody)");
  }

  void pictures() {
    line();
    if (!domain_.drawing()) {
      line("World n is one of the model's MDPs; start m is one of its states. Paths are lists of actions and states.");
      return;
    }
    line(
        "Pictures from left to right: the bare map; the start; the path, one picture per leg (a leg ends where the "
        "robot "
        "acts without moving).");
    out_ += legend(domain_, 2);
    if (!domain_.map()) {
      line("  world n is one of the model's MDPs; start m is one of its states.");
      return;
    }
    line(
        "  world n is the map with some of its optional things (n says which); start m is one of its states: where the "
        "robot, the items and the stations are.");
  }

  void learners() {
    const auto& spec = transcript_.spec;
    line();
    line("The learners:");
    for (const auto& learner : transcript_.record.learners) {
      const auto& type = learner_type(spec, learner.type);
      line(fmt::format("  member {} ({}, {}): {}", learner.member, learner.type, type.label,
                       describe_person(*type.model, type.parameters, learner.traits)));
    }
    line(fmt::format(
        "The teacher assumes that everybody's ability is {} and simulates {} people to choose a demonstration.",
        spec.teaching.assumed_ability, spec.teaching.counterfactuals));
  }

  const Atlas& atlas_;
  const Domain& domain_;
  const Transcript& transcript_;
  std::string out_;
};

}  // namespace

std::string transcript_header(const Atlas& atlas, const Transcript& transcript) {
  return HeaderWriter{atlas, transcript}.text();
}

}  // namespace kith
