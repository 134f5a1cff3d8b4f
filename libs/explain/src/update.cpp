#include "kith/explain/update.hpp"

#include "kith/core/text.hpp"
#include "kith/explain/words.hpp"
#include "kith/teaching/older_robot.hpp"

namespace kith {
namespace {

// What components say that weigh few things; of those in which something is new only that.
RobotUpdate plainest(const Atlas& atlas, const Cone& known) {
  RobotUpdate said;
  const auto& components = atlas.knowledge_components();
  for (const auto& component : components) {
    if (&component == &components.back() && !said.now.empty()) break;  // it weighs all against each other
    RobotUpdate own;
    for (const auto& facet : atlas.constraints().half_spaces(component.constraints)) {
      if (!atlas.prior_cone().implies(facet)) (known.implies(facet) ? own.still : own.now).push_back(facet);
    }
    if (!own.now.empty()) own.still.clear();
    said.now.insert(said.now.end(), own.now.begin(), own.now.end());
    said.still.insert(said.still.end(), own.still.begin(), own.still.end());
  }
  return said;
}

}  // namespace

UpdateInWords update_in_words(const Atlas& atlas, const Cone& known) {
  const auto update = plainest(atlas, known);
  const auto& domain = atlas.domain();
  UpdateInWords words{.now = all_in_words(domain, update.now),
                      .still = all_in_words(domain, update.still),
                      .news = all_in_words(domain, update_of(atlas, known).now),
                      .text = {}};
  if (update.now.empty()) {
    words.text = "The robot has been updated, but it decides as before: all that you know about it still holds.";
    return words;
  }
  words.text = "The robot has been updated. ";
  words.text += words.now.empty() ? "It now decides some things differently." : "Now " + joined(words.now, "; ") + ".";
  if (!words.still.empty()) words.text += " As before, " + joined(words.still, "; ") + ".";
  return words;
}

}  // namespace kith
