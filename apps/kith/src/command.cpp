#include "command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "kith/core/diagnostic.hpp"

namespace kith::cli {
namespace {

// "out" for "out/" and "out/.", which shells and people write: all of them name one folder.
std::string without_slash(std::string path) {
  const auto ends_with = [&](std::string_view end) { return path.size() > end.size() && path.ends_with(end); };
  while (ends_with("/") || ends_with("/.")) path.pop_back();
  return path;
}

template <typename Number>
std::optional<Number> parsed(const std::string& text) {
  Number value{};
  const auto* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end ? std::optional{value} : std::nullopt;
}

// What counts is the value: "1", "1.0" and "1e0" are the same.
double number_of(const std::string& text, const NumberRange& range) {
  const auto value = parsed<double>(text);
  const bool is_above = range.end == NumberRange::kAbove;
  if (value && (is_above ? *value > range.low : *value >= range.low) && *value <= range.high) return *value;
  const auto shown = [](double bound) { return fmt::format("{:.{}f}", bound, bound == std::floor(bound) ? 0 : 6); };
  throw UsageError{fmt::format("must be a number {} {} {} {}, not '{}'", is_above ? "above" : "from", shown(range.low),
                               is_above ? "and at most" : "to", shown(range.high), text)};
}

void require_word(const std::string& text, const std::vector<std::string>& words) {
  if (words.empty() || std::find(words.begin(), words.end(), text) != words.end()) return;
  const auto nearest = nearest_word(text, words);
  throw UsageError{"cannot be '" + text + "'", nearest.empty() ? fmt::format("one of: {}", fmt::join(words, ", "))
                                                               : "did you mean '" + nearest + "'?"};
}

}  // namespace

std::string wrong_integer(const std::string& text, const IntegerRange& range) {
  const auto value = parsed<std::int64_t>(text);
  if (value && *value >= range.min && *value <= range.max) return "";
  const bool is_too_large = !value && !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  return range.max == IntegerRange{}.max && !is_too_large
             ? fmt::format("must be an integer, {} or more, not '{}'", range.min, text)
             : fmt::format("must be an integer from {} to {}, not '{}'", range.min, range.max, text);
}

std::int64_t integer_of(const std::string& text, const IntegerRange& range) {
  if (const auto wrong = wrong_integer(text, range); !wrong.empty()) throw UsageError{wrong};
  return *parsed<std::int64_t>(text);
}

DeclaredOption& DeclaredOption::required() {
  list_.parsers_[index_]->required();
  list_.options_[index_].required = true;
  return *this;
}

DeclaredOption& DeclaredOption::needs(const DeclaredOption& other) {
  list_.parsers_[index_]->needs(list_.parsers_[other.index_]);
  return *this;
}

DeclaredOption& DeclaredOption::excludes(const DeclaredOption& other) {
  list_.parsers_[index_]->excludes(list_.parsers_[other.index_]);
  return *this;
}

OptionList::OptionList(std::string command) : command_{std::move(command)}, app_{std::make_unique<CLI::App>()} {
  app_->set_help_flag();  // help is written by us
}

OptionList::~OptionList() = default;

DeclaredOption OptionList::add(const std::string& name, OptionDescription description,
                               std::function<void(const std::string& text)> take) {
  const auto index = options_.size();
  description.positional = name.front() != '-';
  description.names = CLI::detail::split(description.positional ? description.value : name, ',');
  options_.push_back(description);
  const auto take_all = [this, index, take = std::move(take)](const CLI::results_t& texts) {
    const auto& option = options_[index];
    for (const auto& text : texts) {
      try {
        require_word(text, option.choices);
        take(text);
      } catch (UsageError& error) {
        const char* set = option.environment.empty() ? nullptr : std::getenv(option.environment.c_str());
        error.message = option.names.back() + " " + error.message;
        if (set != nullptr && text == set)
          error.message += " (set by the environment variable " + option.environment + ")";
        throw;
      }
    }
    return true;
  };
  auto* parser = app_->add_option(name, take_all);
  if (description.many) {
    parser->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(description.positional);
  }
  if (description.commas) parser->delimiter(',');
  parsers_.push_back(parser);
  return {*this, index};
}

DeclaredOption OptionList::flag(const std::string& name, bool& value, const std::string& description) {
  options_.push_back({CLI::detail::split(name, ','), "", description});
  parsers_.push_back(app_->add_flag(name, value));
  return {*this, options_.size() - 1};
}

DeclaredOption OptionList::text(const std::string& name, std::string& value, const std::string& type,
                                const std::string& description) {
  return add(name, {{}, type, description, value}, [&value, is_folder = type == "DIR"](const std::string& text) {
    value = is_folder ? without_slash(text) : text;
  });
}

DeclaredOption OptionList::texts(const std::string& name, std::vector<std::string>& values, const std::string& type,
                                 const std::string& description) {
  return add(name, {.value = type, .description = description, .many = true},
             [&values, is_folder = type == "DIR"](const std::string& text) {
               values.push_back(is_folder ? without_slash(text) : text);
             });
}

DeclaredOption OptionList::word(const std::string& name, std::string& value, const std::string& type,
                                const std::vector<std::string>& words, const std::string& description) {
  return add(name, {{}, type, description, value, words}, [&value](const std::string& text) { value = text; });
}

DeclaredOption OptionList::words(const std::string& name, std::vector<std::string>& values, const std::string& type,
                                 const std::vector<std::string>& words, const std::string& description) {
  return add(name, {.value = type, .description = description, .choices = words, .many = true, .commas = true},
             [&values](const std::string& text) { values.push_back(text); });
}

DeclaredOption OptionList::number(const std::string& name, double& value, const std::string& type,
                                  const NumberRange& range, const std::string& description) {
  return add(name, {{}, type, description, value == 0.0 ? "" : fmt::format("{}", value)},
             [&value, range](const std::string& text) { value = number_of(text, range); });
}

DeclaredOption OptionList::value(const std::string& name, const std::string& type, const std::string& description,
                                 std::function<void(const std::string& text)> take) {
  return add(name, {{}, type, description}, std::move(take));
}

DeclaredOption OptionList::study(std::string& value) {
  return text("study", value, "STUDY", "Built-in study or file; '-' is standard input");
}

DeclaredOption OptionList::domain(std::string& value) {
  return text("domain", value, "DOMAIN", "Built-in domain or file");
}

DeclaredOption OptionList::set(std::vector<std::string>& values) {
  return texts("--set", values, "KEY=VALUE", "Set a key of the study (may be repeated)");
}

void OptionList::threads(std::size_t& value, const std::string& promise) {
  constexpr const char* kVariable = "KITH_THREADS";
  integer("-j,--threads", value, {1, 1024}, "Worker threads (default: one per core)" + promise);
  options_.back().environment = kVariable;
  parsers_.back()->envname(kVariable);
}

void OptionList::progress(ProgressMode& value) {
  choice<ProgressMode>("--progress", value, "HOW",
                       {{"auto", ProgressMode::kAuto},
                        {"bar", ProgressMode::kBar},
                        {"json", ProgressMode::kJson},
                        {"none", ProgressMode::kNone}},
                       "How to show progress, on stderr");
}

void OptionList::finish() {
  if (has_json_) flag("--json", common_.json, "Print one JSON document instead of text");
  choice<ColorMode>("--color", common_.color, "WHEN",
                    {{"auto", ColorMode::kAuto}, {"always", ColorMode::kAlways}, {"never", ColorMode::kNever}},
                    "Colours on a terminal");
  flag("-q,--quiet", common_.quiet, "Only results and errors");
  flag("-v,--verbose", common_.verbose, "Print more detail");
  options_.push_back({{"-h"}, "", "Short help with examples"});
  options_.push_back({{"--help"}, "", "Full help"});
}

// As help calls it: "--seed", or "DOMAIN".
std::string OptionList::name_of(const CLI::Option& parser) const {
  const auto found = std::find(parsers_.begin(), parsers_.end(), &parser);
  return options_[static_cast<std::size_t>(found - parsers_.begin())].names.back();
}

UsageError OptionList::unexpected() const {
  const auto left = app_->remaining();
  const auto option = std::find_if(left.begin(), left.end(), [](const auto& word) { return word.rfind('-', 0) == 0; });
  if (option == left.end()) return UsageError{"unexpected argument '" + left.front() + "'"};
  const auto name = option->substr(0, option->find('='));
  if (name == "--json") return UsageError{"kith " + command_ + " prints no JSON"};
  std::vector<std::string> known;
  for (const auto& one : options_) known.insert(known.end(), one.names.begin(), one.names.end());
  const auto nearest = name.rfind("--", 0) == 0 ? nearest_word(name, known) : "";
  return UsageError{"unknown option '" + name + "'", nearest.empty() ? "" : "did you mean '" + nearest + "'?"};
}

// What CLI11 found wrong, in plain words. It says of what kind a mistake is, and its options say where it is.
void OptionList::parse(std::vector<std::string> arguments) try {
  std::reverse(arguments.begin(), arguments.end());
  app_->parse(arguments);
} catch (const CLI::ParseError& error) {
  if (app_->remaining_size() > 0) throw unexpected();
  const auto is = [&](auto kind) { return error.get_exit_code() == static_cast<int>(kind); };
  const std::string what{error.what()};
  for (const auto* parser : parsers_) {
    const auto name = name_of(*parser);
    if (is(CLI::ExitCodes::RequiredError) && parser->get_required() && parser->count() == 0)
      throw UsageError{"kith " + command_ + " needs " + name};
    if (parser->count() == 0) continue;
    for (const auto* other : parser->get_needs()) {
      if (is(CLI::ExitCodes::RequiresError) && other->count() == 0)
        throw UsageError{name + " needs " + name_of(*other)};
    }
    for (const auto* other : parser->get_excludes()) {
      if (is(CLI::ExitCodes::ExcludesError) && other->count() > 0)
        throw UsageError{name + " cannot be combined with " + name_of(*other)};
    }
    const bool is_flag = parser->get_items_expected_max() == 0;
    if (is(CLI::ExitCodes::ConversionError) && is_flag && what.find(parser->get_name()) != std::string::npos)
      throw UsageError{name + " takes no value", "write it alone, or with true or false"};
    if (is(CLI::ExitCodes::ArgumentMismatch) && !is_flag &&
        static_cast<int>(parser->count()) > parser->get_items_expected_max())
      throw UsageError{name + " can be given only once"};
  }
  // "--seed: 1 required N missing"
  const auto* parser = app_->get_option_no_throw(what.substr(0, what.find(':')));
  throw UsageError{parser == nullptr ? what : name_of(*parser) + " needs a value"};
}

Commands all_commands() {
  Commands commands;
  add_init(commands);
  add_validate(commands);
  add_inspect(commands);
  add_infer(commands);
  add_lesson(commands);
  add_ask(commands);
  add_find(commands);
  add_teach(commands);
  add_study(commands);
  add_status(commands);
  add_verify(commands);
  add_merge(commands);
  add_power(commands);
  add_analyze(commands);
  add_report(commands);
  add_fit(commands);
  add_audit(commands);
  add_serve(commands);
  add_session(commands);
  add_explain(commands);
  add_doctor(commands);
  add_version(commands);
  return commands;
}

}  // namespace kith::cli
