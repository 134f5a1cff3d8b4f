// The options of commands about domains and about kith itself, and the parser of all commands.
#include "option_declarations.hpp"

#include <map>

#include "declare_options.hpp"
#include "kith/domains/export_model.hpp"
#include "kith/teaching/strategy.hpp"
#include "option_values.hpp"

namespace kith::cli {
namespace {

void add_validate(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("validate", "Check domain and study files");
  command.add_option("files", options.validate.files, "Files or built-in names to check; '-' is standard input")
      ->required()
      ->type_name("FILE");
  command.add_flag("--strict", options.validate.strict, "Treat warnings as errors");
  add_common(command, options.common);
}

void add_inspect(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("inspect", "Show a domain: map, reward, policy, and what can be taught");
  add_domain_name(command, options.inspect.domain).required();
  takes_word(*command.add_option("--show", options.inspect.show, "What to show, separated by commas")
                  ->delimiter(',')
                  ->allow_extra_args(false),
             "PARTS", inspect_parts());
  takes_integer(*command.add_option("--mdp", options.inspect.mdp,
                                    "Number of the MDP to show (default: the last, with everything)"),
                0);
  command.add_flag("--all", options.inspect.all, "Do not shorten long lists");
  command.add_option("--svg", options.inspect.svg, "Write pictures to this folder: map, policy, region, coverage")
      ->type_name("DIR");
  add_common(command, options.common);
}

void add_init(CLI::App& app, Options& options) {
  auto& init = options.init;
  auto& command = *app.add_subcommand("init", "Write a domain, a study and a README to start from");
  command.add_option("folder", init.folder, "Where to write them")->capture_default_str()->type_name("DIR");
  takes_word(*command.add_option("--template", init.template_name, "What to start from")->capture_default_str(), "NAME",
             {"item-delivery", "blank", "human-study"});
  add_common(command, options.common);
}

void add_curriculum(CLI::App& app, Options& options) {
  auto& curriculum = options.curriculum;
  auto& command =
      *app.add_subcommand("curriculum", "Show what would be taught: demonstrations with reasons, and tests");
  add_domain_name(command, curriculum.domain).required();
  command.add_option("-o,--out", curriculum.out, "Write one HTML page for a browser; '-' is standard output")
      ->type_name("FILE");
  takes_integer(*command.add_option("--seed", curriculum.seed, "Seed of all random streams")->capture_default_str(), 0);
  add_common(command, options.common);
}

void add_ask(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("ask", "Answer a question about the robot with demonstrations");
  add_domain_name(command, options.ask.domain).required();
  command.add_option("question", options.ask.question, "Begins with when, where, why, what or how much")
      ->required()
      ->type_name("QUESTION");
  add_common(command, options.common);
}

void add_find(CLI::App& app, Options& options) {
  auto& find = options.find;
  auto& command = *app.add_subcommand("find", "Find or make a world that teaches or tests exactly one constraint");
  add_domain_name(command, find.domain).required();
  command
      .add_option("constraint", find.constraint,
                  "A normal, such as '(-1,0,2)', or its sentence; without one, all that can be isolated are listed")
      ->type_name("CONSTRAINT");
  command.add_flag("--test", find.test, "For a test rather than for a demonstration");
  command.add_flag("--no-make", find.no_make, "Do not make a world where the domain has none");
  command.add_option("-o,--out", find.out, "Write the world to this file, as a domain of its own")->type_name("FILE");
  add_common(command, options.common);
}

void add_teach(CLI::App& app, Options& options) {
  auto& teach = options.teach;
  std::vector<std::string> names;
  for (const auto& kind : strategy_kinds()) names.emplace_back(kind.name);
  auto& command = *app.add_subcommand("teach", "Teach one simulated team and print a transcript");
  auto* domain = &add_domain_name(command, teach.domain);
  auto* group =
      command.add_option("--group", teach.group, "The members' learner types, one letter each")->type_name("LETTERS");
  auto* strategy =
      &takes_word(*command.add_option("--strategy", teach.strategy, "Whose belief the lessons are chosen for")
                       ->capture_default_str(),
                  "NAME", names);
  auto* seed =
      &takes_integer(*command.add_option("--seed", teach.seed, "Seed of all random streams")->capture_default_str(), 0);
  auto* study = command.add_option("--study", teach.study, "Built-in study or file with the learner types")
                    ->capture_default_str()
                    ->type_name("STUDY");
  auto* set = &add_set(command, teach.set);
  auto* from = command.add_option("--from", teach.from, "Replay a team of this run folder")->type_name("DIR");
  auto* team = command.add_option("--team", teach.team, "Number of the team, as in teams.csv")->type_name("N");
  takes_integer(*command.add_option("--forecast", teach.forecast,
                                    "Forecast the session from this many imagined teams of the same kind"),
                0, 100'000);
  from->needs(team);
  team->needs(from);
  for (auto* other : {domain, group, strategy, seed, study, set}) from->excludes(other);
  add_common(command, options.common);
}

void add_export(CLI::App& app, Options& options) {
  auto& model = options.export_model;
  auto& command = *app.add_subcommand("export", "Write an MDP of a domain in the format of another program");
  add_domain_name(command, model.domain).required();
  takes_word(*command.add_option("--to", model.format, "The format")->required(), "FORMAT", model_format_names());
  takes_integer(*command.add_option("--mdp", model.mdp, "Number of the MDP (default: the only one)"), 0);
  command
      .add_option("-o,--out", model.out,
                  "File to write (default: '-', stdout), or with prism what the names of all files begin with")
      ->type_name("FILE");
  command.add_flag("--yes", model.yes, "Replace existing files");
  add_common(command, options.common);
}

void add_serve(CLI::App& app, Options& options) {
  auto& serve = options.serve;
  auto& command = *app.add_subcommand("serve", "Teach groups of real people in their browsers");
  add_study_name(command, serve.study);
  command.add_option("-o,--out", serve.out, "Folder for the answers; a session in it is resumed")->type_name("DIR");
  add_set(command, serve.set);
  takes_integer(*command.add_option("--port", serve.port,
                                    "Port to listen at; 0: any that is free (default: 8642, and 0 for a rehearsal)"),
                0, 65535);
  command.add_option("--bind", serve.bind, "Address to listen at (default: 127.0.0.1, this machine only)")
      ->type_name("ADDRESS");
  command.add_flag("--lan", serve.lan, "Listen at all addresses of this machine");
  command.add_flag("--insecure-lan", serve.insecure_lan, "With --lan: accept that nothing is encrypted");
  command.add_option("--public-url", serve.public_url, "Address of the reverse proxy that people use")
      ->type_name("URL");
  command
      .add_option("--trusted-proxy", serve.trusted_proxy, "With --public-url: address of a proxy on another machine")
      ->type_name("ADDRESS");
  takes_integer(*command
                     .add_option("--connections-per-address", serve.connections_per_address,
                                 "Connections per address that have not shown a valid link")
                     ->capture_default_str(),
                8, 1'000'000);
  takes_integer(
      *command.add_option("--rooms", serve.rooms, "Make rooms until there are N; others are made as people join"), 0,
      2000);
  takes_integer(*command.add_option("--join-limit", serve.join_limit, "Joins per minute from one address; 0: no limit")
                     ->capture_default_str(),
                0, 1'000'000);
  auto* demo = command.add_flag("--demo", serve.demo, "A first look: a robot to understand, and a room for three");
  command.add_flag("--no-browser", serve.no_browser, "With --demo: do not open a browser")->needs(demo);
  auto* rehearse = &takes_integer(
      *command.add_option("--rehearse", serve.rehearse, "Teach N groups of simulated people instead, and time it"), 1,
      5000);
  const NumberRange any_time{0.0, kLargestNumber};
  takes_number(*command
                    .add_option("--for", serve.for_seconds,
                                "With --rehearse: seconds (default: 0, until everybody has finished)")
                    ->needs(rehearse),
               any_time, "SECONDS");
  takes_number(*command
                    .add_option("--answer-every", serve.answer_every,
                                "With --rehearse: seconds that a person takes for an answer")
                    ->capture_default_str()
                    ->needs(rehearse),
               {0.0, kLargestNumber, NumberRange::kAbove}, "SECONDS");
  takes_number(
      *command
           .add_option("--reconnects", serve.reconnects, "With --rehearse: share of people who reconnect every second")
           ->capture_default_str()
           ->needs(rehearse),
      {0.0, 1.0}, "P");
  takes_number(
      *command
           .add_option("--restart-after", serve.restart_after,
                       "With --rehearse: stop the server after so many seconds and start it again (default: 0, never)")
           ->needs(rehearse),
      any_time, "SECONDS");
  add_common(command, options.common);
}

void add_session(CLI::App& app, Options& options) {
  auto& session = options.session;
  auto& command = *app.add_subcommand("session", "List, export, replay, redact or recover live sessions");
  takes_word(*command.add_option("action", session.action, "What to do")->required(), "ACTION", session_actions());
  command.add_option("folder", session.folder, "Folder that kith serve was given")->required()->type_name("DIR");
  command.add_option("--room", session.room, "Only this room, by id or code")->type_name("ID");
  command.add_option("-o,--out", session.out, "Folder to write tables or the recovered session to")->type_name("DIR");
  command.add_flag("--names", session.names, "Export names, query parameters and completion codes, too");
  command.add_flag("--text", session.text, "Export what people wrote in their own words, too");
  command.add_flag("--yes", session.yes, "Replace an existing export; with redact: erase for good");
  add_common(command, options.common);
}

void add_explain(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("explain", "Say what an error id means, or list kinds and their parameters");
  command
      .add_option("topic", options.explain.id,
                  "An id, such as E0207, or learners, strategies or beliefs; without one, all ids are listed")
      ->type_name("TOPIC");
  add_common(command, options.common);
}

void add_others(CLI::App& app, Options& options) {
  auto& doctor = *app.add_subcommand("doctor", "Check that this machine can run kith");
  add_common(doctor, options.common);
  auto& completion = *app.add_subcommand("completion", "Print a shell's completion script");
  takes_word(*completion.add_option("shell", options.completion.shell, "The shell")->required(), "SHELL",
             {"bash"});
  add_common(completion, options.common);
  auto& version = *app.add_subcommand("version", "Print version, commit and compiler (also: kith --version)");
  add_common(version, options.common);
}

}  // namespace

std::unique_ptr<CLI::App> make_app(Options& options) {
  auto app = std::make_unique<CLI::App>("Teach a robot's policy to a group of people by demonstration", "kith");
  app->set_help_flag();
  app->require_subcommand(1);
  add_init(*app, options);
  add_validate(*app, options);
  add_inspect(*app, options);
  add_curriculum(*app, options);
  add_ask(*app, options);
  add_find(*app, options);
  add_teach(*app, options);
  add_study_commands(*app, options);
  add_serve(*app, options);
  add_session(*app, options);
  add_export(*app, options);
  add_explain(*app, options);
  add_others(*app, options);
  return app;
}

Command command_of(const std::string& name) {
  static const std::map<std::string, Command> kCommands{{"report", Command::kReport},
                                                        {"validate", Command::kValidate},
                                                        {"inspect", Command::kInspect},
                                                        {"teach", Command::kTeach},
                                                        {"study", Command::kStudy},
                                                        {"analyze", Command::kAnalyze},
                                                        {"fit", Command::kFit},
                                                        {"doctor", Command::kDoctor},
                                                        {"completion", Command::kCompletion},
                                                        {"version", Command::kVersion},
                                                        {"calibrate", Command::kCalibrate},
                                                        {"power", Command::kPower},
                                                        {"status", Command::kStatus},
                                                        {"verify", Command::kVerify},
                                                        {"merge", Command::kMerge},
                                                        {"export", Command::kExport},
                                                        {"curriculum", Command::kCurriculum},
                                                        {"ask", Command::kAsk},
                                                        {"init", Command::kInit},
                                                        {"find", Command::kFind},
                                                        {"explain", Command::kExplain},
                                                        {"session", Command::kSession},
                                                        {"serve", Command::kServe},
                                                        {"audit", Command::kAudit}};
  return kCommands.at(name);
}

const std::vector<std::string>& inspect_parts() {
  static const std::vector<std::string> kParts{"map", "policy", "bec", "kc", "demos", "tests", "counterfactuals"};
  return kParts;
}

}  // namespace kith::cli
