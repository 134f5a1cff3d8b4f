#pragma once

#include <optional>
#include <string>
#include <vector>

#include "options.hpp"

namespace kith::cli {

/// One option, flag or positional argument, as help and completion need it.
struct OptionDescription {
  std::vector<std::string> names;  ///< "-o", "--out"; for positionals the one name "STUDY".
  std::string value;               ///< Placeholder of its value; empty for flags.
  std::string description;
  std::string default_text;
  std::vector<std::string> choices;  ///< The words it takes, if it takes one of a few.
  std::string environment;           ///< The environment variable that sets it; may be empty.
  bool positional = false;
  bool required = false;
  bool many = false;
};

/// One command: what help and completion are written from.
struct CommandDescription {
  std::string name;
  std::string summary;
  std::vector<std::string> examples;  ///< Two.
  std::vector<OptionDescription> options;
};

/// A command line that was not understood (exit 2).
struct UsageError {
  std::string message;
  std::string hint;
  std::string command;  ///< Whose help to read; may be empty.
};

/// What a command line asks for: something to do, a text to print, or a complaint.
struct ParsedCommandLine {
  std::optional<Options> options;
  std::optional<std::string> text;
  std::optional<UsageError> error;
};

/// Understands the arguments behind the program's name, and the environment
/// variable KITH_THREADS if --threads was not given.
[[nodiscard]] ParsedCommandLine parse_command_line(const std::vector<std::string>& given);

/// All commands, in the order of the help.
[[nodiscard]] std::vector<CommandDescription> describe_commands();

}  // namespace kith::cli
