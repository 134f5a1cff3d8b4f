#include "declare_options.hpp"

#include <string_view>

#include "option_values.hpp"

namespace kith::cli {
namespace {

// "out" for "out/" and "out/.", which completion and people write: all of them name one folder.
std::string without_slash(std::string path) {
  const auto ends_with = [&](std::string_view end) { return path.size() > end.size() && path.ends_with(end); };
  while (ends_with("/") || ends_with("/.")) path.pop_back();
  return path;
}

std::string braces(const std::vector<std::string>& words) {
  std::string text = "{";
  for (const auto& word : words) text += (text.size() > 1 ? "," : "") + word;
  return text + "}";
}

}  // namespace

CLI::Option& takes_word(CLI::Option& option, const std::string& type, const std::vector<std::string>& words) {
  return *option.check([words](const std::string& text) { return wrong_word(text, words); })
              ->type_name(type + ":" + braces(words));
}

CLI::Option& takes_number(CLI::Option& option, const NumberRange& range, const std::string& type) {
  return *option.check([range](const std::string& text) { return wrong_number(text, range); })->type_name(type);
}

CLI::Option& takes_integer(CLI::Option& option, std::int64_t min, std::int64_t max) {
  return *option.check([min, max](const std::string& text) { return wrong_integer(text, min, max); })->type_name("N");
}

void add_common(CLI::App& command, CommonOptions& common) {
  command.set_help_flag();
  command.add_flag("--json", common.json, "Print one JSON document instead of text");
  add_mode<ColorMode>(command, "--color", common.color, "Colours on a terminal", "WHEN",
                      {{"auto", ColorMode::kAuto}, {"always", ColorMode::kAlways}, {"never", ColorMode::kNever}});
  command.add_flag("-q,--quiet", common.quiet, "Only results and errors");
  command.add_flag("-v,--verbose", common.verbosity, "Print more detail; repeat for more");
  for (auto* option : command.get_options()) {
    if (option->get_type_name() == "DIR") option->transform(without_slash, "");
  }
}

CLI::Option& add_study_name(CLI::App& command, std::string& study) {
  return *command.add_option("study", study, "Built-in study or file; '-' is standard input")->type_name("STUDY");
}

CLI::Option& add_domain_name(CLI::App& command, std::string& domain) {
  return *command.add_option("domain", domain, "Built-in domain or file")->type_name("DOMAIN");
}

CLI::Option& add_set(CLI::App& command, std::vector<std::string>& set) {
  return *command.add_option("--set", set, "Set a key of the study (may be repeated)")
              ->allow_extra_args(false)
              ->type_name("KEY=VALUE");
}

void add_thread_count(CLI::App& command, std::size_t& threads, const std::string& description) {
  takes_integer(*command.add_option("-j,--threads", threads, description)->envname("KITH_THREADS"), 1, 1024);
}

void add_threads(CLI::App& command, std::size_t& threads) {
  add_thread_count(command, threads, "Worker threads (default: one per core); never changes a result");
}

void add_progress(CLI::App& command, ProgressMode& mode) {
  add_mode<ProgressMode>(command, "--progress", mode, "How to show progress, on stderr", "HOW",
                         {{"auto", ProgressMode::kAuto},
                          {"bar", ProgressMode::kBar},
                          {"json", ProgressMode::kJson},
                          {"none", ProgressMode::kNone}});
}

void add_shard(CLI::App& command, ShardOption& shard) {
  command
      .add_option_function<std::string>(
          "--shard", [&shard](const std::string& text) { shard = *shard_of(text); },
          "Run part I of N; kith merge combines the parts")
      ->check([](const std::string& text) {
        return shard_of(text) ? "" : "must be I/N, such as 2/7, with I from 1 to N, not '" + text + "'";
      })
      ->type_name("I/N");
}

}  // namespace kith::cli
