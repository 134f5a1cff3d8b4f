#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "console.hpp"
#include "kith/core/error.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
class Option;
}  // namespace CLI

namespace kith::cli {

/// A command line that was not understood (exit 2).
struct UsageError : std::exception {
  explicit UsageError(std::string what, std::string how = {}) : message{std::move(what)}, hint{std::move(how)} {}
  [[nodiscard]] const char* what() const noexcept override { return message.c_str(); }
  std::string message;
  std::string hint;
  std::string command{};  ///< Whose help to read; may be empty.
};

/// For options that do not go together, or that name what does not exist. @throws kith::Error (kUsage).
[[noreturn]] inline void refuse(const std::string& message, const Advice& advice = {}) {
  if (advice.hint.empty() && advice.remedy == Remedy::kNone) throw Error{ErrorKind::kUsage, message};
  throw Error{ErrorKind::kUsage, message, advice};
}

/// The integers that an option takes.
struct IntegerRange {
  std::int64_t min = 0;
  std::int64_t max = std::numeric_limits<std::int64_t>::max();
};

/// The numbers that an option takes: from `low` to `high`, or only those above `low`.
struct NumberRange {
  enum End { kFrom, kAbove };
  double low = 0.0;
  double high = 1.0;
  End end = kFrom;
};
inline constexpr double kLargestNumber = 1e6;

/// One option, flag or positional argument, as help needs it.
struct OptionDescription {
  std::vector<std::string> names{};  ///< "-o", "--out"; for positionals the one name "STUDY".
  std::string value{};               ///< Placeholder of its value; empty for flags.
  std::string description{};
  std::string default_text{};
  std::vector<std::string> choices{};  ///< The words it takes, if it takes one of a few.
  std::string environment{};           ///< The environment variable that sets it; may be empty.
  bool positional = false;
  bool required = false;
  bool many = false;
  bool commas = false;  ///< Between its values.
};

/// Why the text is no integer of this range ("must be an integer from 1 to 9, not 'x'"), or nothing.
[[nodiscard]] std::string wrong_integer(const std::string& text, const IntegerRange& range);
/// The integer. @throws UsageError, which says why it is none.
[[nodiscard]] std::int64_t integer_of(const std::string& text, const IntegerRange& range);

class OptionList;

/// An option that was declared, to say what it goes with.
class DeclaredOption {
 public:
  DeclaredOption& required();
  DeclaredOption& needs(const DeclaredOption& other);
  DeclaredOption& excludes(const DeclaredOption& other);

 private:
  friend OptionList;
  DeclaredOption(OptionList& list, std::size_t index) : list_{list}, index_{index} {}
  OptionList& list_;
  std::size_t index_;
};

/// The options of a command, declared one by one in the order of its help, each with the place for its value. What the
/// place holds is the default, and help shows it unless it is empty or 0. A name without a dash is a positional
/// argument.
class OptionList {
 public:
  explicit OptionList(std::string command);
  ~OptionList();
  OptionList(const OptionList&) = delete;
  OptionList& operator=(const OptionList&) = delete;

  DeclaredOption flag(const std::string& name, bool& value, const std::string& description);
  /// @param type  "FILE"; the slash at the end of a "DIR" is left out.
  DeclaredOption text(const std::string& name, std::string& value, const std::string& type,
                      const std::string& description);
  /// May be given several times. A positional argument takes all that follow.
  DeclaredOption texts(const std::string& name, std::vector<std::string>& values, const std::string& type,
                       const std::string& description);
  /// One of a few words, or (a list) several of them, separated by commas.
  DeclaredOption word(const std::string& name, std::string& value, const std::string& type,
                      const std::vector<std::string>& words, const std::string& description);
  DeclaredOption words(const std::string& name, std::vector<std::string>& values, const std::string& type,
                       const std::vector<std::string>& words, const std::string& description);
  /// One of a few ways, each with its word.
  template <typename Way>
  DeclaredOption choice(const std::string& name, Way& value, const std::string& type,
                        const std::vector<std::pair<std::string, Way>>& ways, const std::string& description) {
    std::vector<std::string> words;
    for (const auto& way : ways) words.push_back(way.first);
    return add(name, {.value = type, .description = description, .choices = words}, [&value, ways](const auto& text) {
      for (const auto& [word, way] : ways) {
        if (word == text) value = way;
      }
    });
  }
  /// @tparam Integer  an integer type, an optional of one, or a vector, which takes integers separated by commas.
  template <typename Integer>
  DeclaredOption integer(const std::string& name, Integer& value, const IntegerRange& range,
                         const std::string& description) {
    OptionDescription option{.value = "N", .description = description};
    if constexpr (std::is_integral_v<Integer>) {
      if (value != 0) option.default_text = std::to_string(value);
    }
    option.many = option.commas = requires { value.push_back(0); };
    return add(name, option, [&value, range](const std::string& text) {
      const auto number = integer_of(text, range);
      if constexpr (std::is_integral_v<Integer>) {
        value = static_cast<Integer>(number);
      } else if constexpr (requires { value.push_back(0); }) {
        value.push_back(static_cast<typename Integer::value_type>(number));
      } else {
        value = static_cast<typename Integer::value_type>(number);
      }
    });
  }
  DeclaredOption number(const std::string& name, double& value, const std::string& type, const NumberRange& range,
                        const std::string& description);
  /// Any other: `take` understands the text, and throws UsageError with the end of a sentence ("must be I/N").
  DeclaredOption value(const std::string& name, const std::string& type, const std::string& description,
                       std::function<void(const std::string& text)> take);

  // What several commands have.
  DeclaredOption study(std::string& value);
  DeclaredOption domain(std::string& value);
  DeclaredOption set(std::vector<std::string>& value);
  /// -j, which the environment variable KITH_THREADS sets too. No other option has one: what answers a question, names
  /// a place or changes a result is said where it is meant.
  void threads(std::size_t& value, const std::string& promise = {});
  void progress(ProgressMode& value);
  /// --json, for commands whose results programs read.
  void json() { has_json_ = true; }

  /// Adds what every command has.
  void finish();
  /// Understands the arguments behind the name of the command. @pre finish() was called. @throws UsageError.
  void parse(std::vector<std::string> arguments);
  [[nodiscard]] const std::vector<OptionDescription>& options() const noexcept { return options_; }
  [[nodiscard]] const CommonOptions& common() const noexcept { return common_; }

 private:
  friend DeclaredOption;
  DeclaredOption add(const std::string& name, OptionDescription description,
                     std::function<void(const std::string& text)> take);
  [[nodiscard]] std::string name_of(const CLI::Option& parser) const;
  [[nodiscard]] UsageError unexpected() const;  // arguments

  std::string command_;
  std::unique_ptr<CLI::App> app_;
  std::vector<OptionDescription> options_;
  std::vector<CLI::Option*> parsers_;  // of the options, in their order
  CommonOptions common_;
  bool has_json_ = false;
};

/// A command, all in one place: what help says of it, its options, and what it does.
struct Command {
  std::string name;
  std::string summary;
  std::vector<std::string> examples;
  /// Declares the options; what is returned runs the command with them and returns the exit code. What goes wrong is
  /// thrown as kith::Error.
  std::function<std::function<int(Console&)>(OptionList&)> declare;
};

/// All commands, in the order of the help.
class Commands {
 public:
  /// @param declare  the options and where their values go.
  template <typename Options>
  void add(const std::string& name, const std::string& summary, const std::vector<std::string>& examples,
           void (*declare)(OptionList&, Options&), int (*run)(const Options&, Console&)) {
    all_.push_back({name, summary, examples, [declare, run](OptionList& list) {
                      auto options = std::make_shared<Options>();
                      declare(list, *options);
                      return [options, run](Console& console) { return run(*options, console); };
                    }});
  }
  /// Without options of its own.
  void add(const std::string& name, const std::string& summary, const std::vector<std::string>& examples,
           int (*run)(Console&)) {
    all_.push_back({name, summary, examples, [run](OptionList&) { return run; }});
  }
  [[nodiscard]] const std::vector<Command>& all() const noexcept { return all_; }

 private:
  std::vector<Command> all_;
};

// Each in the file of its command.
void add_analyze(Commands& commands);
void add_ask(Commands& commands);
void add_audit(Commands& commands);
void add_lesson(Commands& commands);
void add_doctor(Commands& commands);
void add_explain(Commands& commands);
void add_find(Commands& commands);
void add_fit(Commands& commands);
void add_infer(Commands& commands);
void add_init(Commands& commands);
void add_inspect(Commands& commands);
void add_merge(Commands& commands);
void add_power(Commands& commands);
void add_report(Commands& commands);
void add_serve(Commands& commands);
void add_session(Commands& commands);
void add_status(Commands& commands);
void add_study(Commands& commands);
void add_teach(Commands& commands);
void add_validate(Commands& commands);
void add_verify(Commands& commands);
void add_version(Commands& commands);
[[nodiscard]] Commands all_commands();

}  // namespace kith::cli
