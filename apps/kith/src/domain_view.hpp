#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "console.hpp"
#include "kith/domains/domain.hpp"

namespace kith::cli {

/// What can be shown of any domain, whether or not its weights can be taught.
class DomainView {
 public:
  /// @throws kith::Error (kUsage) if the domain has no MDP of that number.
  /// @param mdp  none: the last, which has everything. @param all  no list is cut short.
  DomainView(const Domain& domain, std::optional<std::size_t> mdp, bool all, const Console& console);

  /// The MDP to show.
  [[nodiscard]] MdpIndex mdp() const noexcept { return mdp_; }
  [[nodiscard]] std::string title() const;
  [[nodiscard]] std::string map() const;     ///< With the legend of the symbols; without a map the size of the model.
  [[nodiscard]] std::string reward() const;  ///< Raw and at length 1.
  [[nodiscard]] std::string policy() const;  ///< For every configuration on the way from the start, or as a table.

 private:
  [[nodiscard]] std::string heading(const std::string& text) const { return "\n" + console_.bold(text) + "\n"; }

  [[nodiscard]] std::string model() const;         // what there is instead of a map
  [[nodiscard]] std::string policy_table() const;  // what there is instead of arrows

  const Domain& domain_;
  const Console& console_;
  bool all_;
  MdpIndex mdp_;
};

}  // namespace kith::cli
