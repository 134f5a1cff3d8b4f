// What kinds there are, with their parameters.

#include "command.hpp"
#include "kind_lists.hpp"

namespace kith::cli {
namespace {

struct ExplainOptions {
  std::string topic;  ///< Which kinds: "strategies".
};

void declare(OptionList& list, ExplainOptions& options) {
  std::vector<std::string> topics;
  for (const auto& kinds : kind_lists()) topics.emplace_back(kinds.topic);
  list.word("topic", options.topic, "TOPIC", topics, "Which kinds").required();
}

int run(const ExplainOptions& options, Console& console) {
  for (const auto& kinds : kind_lists()) {
    if (kinds.topic == options.topic) console.print(to_text(kinds, console));
  }
  return 0;
}

}  // namespace

void add_explain(Commands& commands) {
  commands.add<ExplainOptions>("explain", "List kinds of learners, strategies, beliefs, stop rules",
                               {"kith explain strategies", "kith explain learners"}, declare, run);
}

}  // namespace kith::cli
