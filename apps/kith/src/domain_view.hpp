#pragma once

#include <string>

#include "console.hpp"
#include "kith/domains/domain.hpp"

namespace kith::cli {

/// What can be shown of any domain, whether or not its weights can be taught.
class DomainView {
 public:
  /// @throws kith::Error (kUsage) if the domain has no MDP of the number in the options.
  DomainView(const Domain& domain, const InspectOptions& options, const Console& console);

  /// The MDP to show: the one asked for, else the last, which has everything.
  [[nodiscard]] MdpIndex mdp() const noexcept { return mdp_; }
  [[nodiscard]] std::string title() const;
  [[nodiscard]] std::string map() const;     ///< With the legend of the symbols.
  [[nodiscard]] std::string reward() const;  ///< Raw and at length 1.
  [[nodiscard]] std::string policy() const;  ///< For every configuration on the way from the start.

 private:
  [[nodiscard]] std::string heading(const std::string& text) const { return "\n" + console_.bold(text) + "\n"; }
  [[nodiscard]] std::string configuration(const GridState& state) const;

  const Domain& domain_;
  const Console& console_;
  MdpIndex mdp_;
};

}  // namespace kith::cli
