#pragma once

// What the declarations of options are made of. Only they include this and CLI11, which takes long to compile.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "option_values.hpp"
#include "options.hpp"

namespace kith::cli {

/// An option whose value is one of a few words; help and completion list them.
CLI::Option& takes_word(CLI::Option& option, const std::string& type, const std::vector<std::string>& words);

/// An option whose value is an integer from `min` to `max`.
CLI::Option& takes_integer(CLI::Option& option, std::int64_t min,
                           std::int64_t max = std::numeric_limits<std::int64_t>::max());

/// An option whose value is a number in a range.
CLI::Option& takes_number(CLI::Option& option, const NumberRange& range, const std::string& type);

/// An option that chooses one of a few ways, each with its word.
template <typename Mode>
void add_mode(CLI::App& command, const std::string& name, Mode& mode, const std::string& description,
              const std::string& type, const std::vector<std::pair<std::string, Mode>>& modes) {
  std::vector<std::string> words;
  for (const auto& one : modes) words.push_back(one.first);
  const auto set = [&mode, modes](const std::string& text) {
    for (const auto& one : modes) {
      if (one.first == text) mode = one.second;
    }
  };
  takes_word(*command.add_option_function<std::string>(name, set, description), type, words);
}

/// What every command has; help and completion are written by us. Call last.
void add_common(CLI::App& command, CommonOptions& common);

/// The study or the domain that a command is about.
CLI::Option& add_study_name(CLI::App& command, std::string& study);
CLI::Option& add_domain_name(CLI::App& command, std::string& domain);
/// --set.
CLI::Option& add_set(CLI::App& command, std::vector<std::string>& set);
/// -j, which the environment variable KITH_THREADS sets too. No other option has one: what answers a question, names a
/// place or changes a result is said where it is meant.
void add_thread_count(CLI::App& command, std::size_t& threads, const std::string& description);
void add_threads(CLI::App& command, std::size_t& threads);
/// --progress.
void add_progress(CLI::App& command, ProgressMode& mode);
/// --shard.
void add_shard(CLI::App& command, ShardOption& shard);

/// The commands that run and plan studies, look after run folders, and analyse results, in the order of help.
void add_study_commands(CLI::App& app, Options& options);

}  // namespace kith::cli
