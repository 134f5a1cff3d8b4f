#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kith/explain/audit_report.hpp"
#include "kith/explain/board_svg.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/picture.hpp"
#include "kith/explain/words.hpp"
#include "kith/teaching/kind_of_person.hpp"

namespace kith {
namespace {

constexpr std::string_view kStyle = R"(
*,*::before,*::after{box-sizing:border-box}
:root{--ground:#fff;--panel:#f6f7f8;--text:#1c2127;--muted:#57606a;--line:#d5dade;--good:#1f6f43;--bad:#9a3412;--open:#5a5f66;--bar:#3b6ea5}
body{margin:0;background:var(--ground);color:var(--text);font:16px/1.5 "Helvetica Neue",Helvetica,Arial,"Liberation Sans",sans-serif}
main{max-width:980px;margin:0 auto;padding:24px 20px 80px}
h1{font-size:28px;line-height:1.2;margin:0 0 8px}
h2{font-size:21px;margin:40px 0 8px;padding-top:20px;border-top:1px solid var(--line)}
h3{font-size:17px;margin:24px 0 4px}
p{margin:0 0 10px;max-width:74ch}
.muted{color:var(--muted)}
.caution{color:var(--bad)}
.scroll{overflow-x:auto}
table{border-collapse:collapse;margin:8px 0 20px}
th,td{text-align:left;padding:5px 14px 5px 0;border-bottom:1px solid var(--line);vertical-align:top}
td.n,th.n{text-align:right}
tbody th{font-weight:600}
.scroll:focus-visible{outline:2px solid var(--bar);outline-offset:2px}
.verdict{font-weight:650}
.understands{color:var(--good)}.misconception{color:var(--bad)}.cannot-tell,.not-taught{color:var(--open)}
article{border:1px solid var(--line);border-radius:8px;padding:12px 16px;margin:10px 0;break-inside:avoid}
article h4{font-size:16px;margin:0 0 4px}
.boards{display:flex;flex-wrap:wrap;gap:20px;margin:8px 0 0}
figure{margin:0;max-width:100%}
svg{max-width:100%;height:auto}
figure svg{border:1px solid var(--line)}
figcaption{font-size:14px;max-width:44ch}
ul{margin:0 0 10px;padding-left:22px}
summary{cursor:pointer}
@media print{main{padding:0}h2{break-before:auto}}
)";

constexpr double kPercent = 100.0;

std::string percent(double share) { return fmt::format("{:.0f} %", kPercent * share); }

std::string tag(std::string_view name, std::string_view text, std::string_view attributes = "") {
  return fmt::format("<{0}{1}{2}>{3}</{0}>\n", name, attributes.empty() ? "" : " ", attributes, svg_escaped(text));
}

class Page {
 public:
  Page(const Atlas& atlas, const AuditReport& report, const std::string& program)
      : atlas_{atlas}, domain_{atlas.domain()}, report_{report}, program_{program} {
    if (const auto map = domain_.drawing()) boards_.emplace(*map);
  }

  std::string text() {
    head();
    who_needs_what();
    summary();
    misconceptions();
    std::string group;
    for (const auto& person : report_.people) {
      if (person.group != group) {
        out_ += tag("h2", sentence(person.group));
        out_ += tag("p", agreement_in_words(report_, person.group));
      }
      group = person.group;
      this->person(person);
    }
    method();
    out_ += "</main>\n</body>\n</html>\n";
    return std::move(out_);
  }

 private:
  static std::string sentence(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return text;
  }

  void head() {
    out_ = fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Who understands what: "
        "{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n",
        svg_escaped(source()), kStyle);
    out_ += tag("h1", "Who understands what");
    out_ += tag(
        "p",
        fmt::format("{} of {}, judged by their answers. {}", counted_people(report_.people.size()), source(), program_),
        "class=\"muted\"");
  }

  // The name of the folder, without where it is on this machine.
  [[nodiscard]] std::string source() const {
    auto path = std::filesystem::path{report_.source}.lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    const auto name = path.filename().string();
    return name.empty() || name == "." || name == ".." ? "this study" : name;
  }

  void begin_table(const std::string& name) {
    out_ += fmt::format("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\"><table>\n",
                        svg_escaped(name));
  }

  // How soon something has to be done about it.
  static int urgency(const ComponentAudit& audit) {
    switch (audit.understanding) {
      case Understanding::kMisconception:
        return 0;
      case Understanding::kCannotTell:
        return 1;
      case Understanding::kNotTaught:
        return 2;
      case Understanding::kUnderstands:
        break;
    }
    return 3;
  }

  // The component about which to do something first: the most urgent one that is understood least.
  static const ComponentAudit& first_need(const PersonAudit& person) {
    return *std::min_element(person.components.begin(), person.components.end(), [](const auto& a, const auto& b) {
      return std::pair{urgency(a), a.level.mean} < std::pair{urgency(b), b.level.mean};
    });
  }

  [[nodiscard]] std::string need_in_words(const ComponentAudit& audit) const {
    const auto component = component_in_words(atlas_, audit.component);
    switch (audit.understanding) {
      case Understanding::kMisconception:
        return fmt::format("Show that {}. Probably thinks that {}.", audit.misconception->fact,
                           audit.misconception->thinks);
      case Understanding::kCannotTell:
        return fmt::format("Test {}.{}", component,
                           audit.misconception ? " Might think that " + audit.misconception->thinks + "." : "");
      case Understanding::kNotTaught:
        return fmt::format("Teach {}.", component);
      case Understanding::kUnderstands:
        break;
    }
    return sentence(advice_in_words(audit)) + ".";
  }

  // One row per person, those who need something first at the top.
  void who_needs_what() {
    std::vector<const AuditedPerson*> order;
    for (const auto& person : report_.people) {
      if (!person.audit.components.empty()) order.push_back(&person);
    }
    if (order.empty()) return;
    std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) {
      const auto &x = first_need(a->audit), &y = first_need(b->audit);
      return std::pair{urgency(x), x.level.mean} < std::pair{urgency(y), y.level.mean};
    });

    const bool has_groups =
        order.front()->group != order.back()->group ||
        std::any_of(order.begin(), order.end(), [&](const auto* one) { return one->group != order.front()->group; });

    out_ += tag("h2", "Who needs what first");
    begin_table("Who needs what first");
    out_ += "<thead><tr><th>Person</th>";
    for (std::size_t k = 0; k < atlas_.knowledge_components().size(); ++k) out_ += fmt::format("<th>{}</th>", k + 1);
    out_ += "<th>First</th></tr></thead>\n<tbody>\n";

    for (const auto* person : order) {
      const auto name = title_of(*person) + (has_groups ? ", " + person->group : "");
      out_ += fmt::format("<tr><th scope=\"row\"><a href=\"#{}\">{}</a></th>", anchor(*person), svg_escaped(name));
      for (const auto& audit : person->audit.components) {
        out_ += fmt::format("<td class=\"{}\">{}</td>", name_of(audit.understanding), in_words(audit.understanding));
      }
      out_ += fmt::format("<td>{}</td></tr>\n", svg_escaped(need_in_words(first_need(person->audit))));
    }
    out_ += "</tbody></table></div>\n";

    std::string components;
    for (std::size_t k = 0; k < atlas_.knowledge_components().size(); ++k) {
      components += fmt::format("{}{}: {}", k == 0 ? "" : "; ", k + 1, component_in_words(atlas_, k));
    }
    out_ += tag("p", components + ".", "class=\"muted\"");
  }

  [[nodiscard]] std::string anchor(const AuditedPerson& person) const {
    return fmt::format("person-{}", &person - report_.people.data() + 1);
  }

  static std::string counted_people(std::size_t n) { return n == 1 ? "1 person" : std::to_string(n) + " people"; }

  void summary() {
    out_ += tag("h2", "By component");
    begin_table("By component");
    out_ +=
        "<tr><th>Component</th><th class=\"n\">understand</th>"
        "<th class=\"n\">cannot tell yet</th><th class=\"n\">misconception</th><th class=\"n\">not taught</th></tr>\n";
    for (std::size_t k = 0; k < atlas_.knowledge_components().size(); ++k) {
      const auto counts = counts_of(report_, k);
      out_ += fmt::format(
          "<tr><td>{}. {}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
          "<td class=\"n\">{}</td></tr>\n",
          k + 1, svg_escaped(component_in_words(atlas_, k)), counts.understand, counts.cannot_tell,
          counts.misconception, counts.not_taught);
    }
    out_ += "</table></div>\n";
    out_ += tag("p", agreement_in_words(report_));
    if (const auto older = older_in_words(report_); !older.empty()) out_ += tag("p", older);
  }

  void misconceptions() {
    const auto shared = shared_misconceptions(report_);
    if (shared.empty()) {
      out_ += tag("p", "Nobody shows a misconception.");
      return;
    }
    begin_table("Misconceptions");
    out_ +=
        "<tr><th class=\"n\">People</th><th>think that</th><th>in fact</th>"
        "<th>Component</th></tr>\n";
    for (const auto& misconception : shared) {
      out_ += fmt::format("<tr><td class=\"n\">{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", misconception.people,
                          svg_escaped(misconception.thinks.front()), svg_escaped(misconception.fact),
                          misconception.component + 1);
    }
    out_ += "</table></div>\n";
  }

  void person(const AuditedPerson& person) {
    out_ += tag("h3", title_of(person), fmt::format("id=\"{}\"", anchor(person)));
    const auto caution = caution_in_words(person.audit);
    if (!caution.empty()) out_ += tag("p", caution, "class=\"caution\"");
    if (const auto knows = person.audit.knowledge()) {
      out_ += tag("p", fmt::format("Knows {} of what was taught.", percent(*knows)));
    }
    if (const auto older = older_in_words(person.audit); !older.empty()) out_ += tag("p", "This person " + older + ".");
    if (!person.kinds.empty()) out_ += tag("p", "Kind of learner: " + kinds_in_words(person.kinds) + ".");
    for (const auto& audit : person.audit.components) component(audit);
  }

  void component(const ComponentAudit& audit) {
    out_ += "<article>\n";
    out_ += fmt::format("<h4>{}. {}: <span class=\"verdict {}\">{}</span></h4>\n", audit.component + 1,
                        svg_escaped(component_in_words(atlas_, audit.component)), name_of(audit.understanding),
                        verdict_in_words(audit));
    if (audit.understanding != Understanding::kNotTaught) {
      level(audit);
      if (audit.misconception) misconception(audit);
      const auto advice = advice_in_words(audit);
      out_ += "<p><b>Next:</b> " + svg_escaped(advice) + ".</p>\n";
      boards(audit);
    }
    out_ += "</article>\n";
  }

  void level(const ComponentAudit& audit) {
    const bool is_high = audit.level.probability >= report_.options.sure;
    const bool is_luck = is_high && audit.understanding == Understanding::kCannotTell;
    out_ += tag("p", fmt::format("{} of {} right in {}.{}", audit.correct, counted(audit.tests, "answer"),
                                 counted(audit.periods, "lesson"),
                                 is_luck ? " Somebody who does not learn may answer like that, too." : ""));
    bar(audit.level);
  }

  // The interval on a line from 0 to 100 %, the expectation as a dot, and what counts as enough.
  void bar(const CredibleLevel& level) {
    constexpr double kWidth = 320.0, kHeight = 38.0, kEdge = 16.0, kMiddle = 11.0, kText = 34.0;
    const auto at = [&](double share) { return kEdge + share * (kWidth - 2.0 * kEdge); };
    Svg svg;
    svg.line(at(0.0), kMiddle, at(1.0), kMiddle, {{"stroke", "#d5dade"}, {"stroke-width", "2"}});
    const auto enough = at(report_.options.level.enough);
    svg.line(enough, 2.0, enough, 2.0 * kMiddle - 2.0,
             {{"stroke", "#57606a"}, {"stroke-width", "1"}, {"stroke-dasharray", "3 2"}});
    svg.line(at(level.low), kMiddle, at(level.high), kMiddle, {{"stroke", "#3b6ea5"}, {"stroke-width", "6"}});
    svg.add("circle",
            {{"cx", svg_number(at(level.mean))}, {"cy", svg_number(kMiddle)}, {"r", "5"}, {"fill", "#1c2127"}});
    for (const double share : {0.0, report_.options.level.enough, 1.0}) {
      svg.add("text",
              {{"x", svg_number(at(share))},
               {"y", svg_number(kText)},
               {"font-size", "11"},
               {"text-anchor", "middle"},
               {"fill", "#57606a"}},
              percent(share));
    }
    out_ += svg.file(kWidth, kHeight,
                     fmt::format("{}, between {} and {}; {} is enough", percent(level.mean), percent(level.low),
                                 percent(level.high), percent(report_.options.level.enough)));
  }

  void misconception(const ComponentAudit& audit) {
    const auto& found = *audit.misconception;
    const bool sure = audit.understanding == Understanding::kMisconception;
    out_ += fmt::format("<p>{} that {} (probability {}). In fact, {}.</p>\n",
                        sure ? "<b>Probably thinks</b>" : "Might think", svg_escaped(found.thinks),
                        percent(found.probability), svg_escaped(found.fact));
    if (found.answers.empty()) return;
    out_ += tag("p", found.answers.size() == 1 ? "The answer that shows it:" : "Answers that show it:") + "<ul>\n";
    for (const auto& answer : found.answers) {
      out_ += tag("li", fmt::format("period {}, test {} ({}), predicted: {}", answer.period, answer.test,
                                    world_text(atlas_.domain(), atlas_.id(answer.demo).mdp), answer.text));
    }
    out_ += "</ul>\n";
  }

  void boards(const ComponentAudit& audit) {
    std::string figures;
    if (audit.understanding == Understanding::kMisconception && audit.misconception->show) {
      figures += figure(*audit.misconception->show, "Show", audit.misconception->reason);
    }
    if (audit.test) figures += figure(*audit.test, "Test", "ask what the robot does from here");
    if (figures.empty()) return;
    figures = "<div class=\"boards\">\n" + figures + "</div>\n";
    // What is not urgent opens on demand.
    const bool is_urgent = audit.understanding == Understanding::kMisconception;
    out_ += is_urgent ? figures : "<details><summary>Board to test this</summary>\n" + figures + "</details>\n";
  }

  [[nodiscard]] std::string figure(StartIndex demo, const std::string& purpose, const std::string& text) const {
    const auto id = atlas_.id(demo);
    const auto path = atlas_.trajectory(demo);
    const auto caption =
        fmt::format("{}: {}, start {}{}{}. The robot: {}.", purpose, world_text(domain_, id.mdp), id.start.value(),
                    text.empty() ? "" : "; ", text, actions_text(domain_, id.mdp, path));
    std::string picture;
    if (boards_) {
      auto svg = boards_->board(id.mdp, domain_.drawing()->state(id.mdp, id.start));
      svg.add(0.0, 0.0, boards_->path(id.mdp, path, "#3b6ea5"));
      picture = svg.file(boards_->width(), boards_->height(), caption);
    }
    return "<figure>\n" + picture + tag("figcaption", caption) + "</figure>\n";
  }

  void method() {
    const auto& options = report_.options;
    out_ += tag("h2", "How to read this");
    out_ += tag(
        "p", fmt::format("A person understands a component if, asked at any time, they would predict the robot rightly "
                         "on all of it at least {} of the time. The page says so only if that is at least {} certain. "
                         "A misconception is named if the person would more likely than not go by it in the next test. "
                         "Dot and bar: how often all of it is expected to be right, with its {} interval.",
                         percent(options.level.enough), percent(options.sure), percent(options.level.coverage)));
    out_ +=
        tag("p", fmt::format("The answers of each group are compared with what the model of how people learn expects "
                             "of it. p is the probability of a number of right answers at least as far from that: "
                             "where it is small, trust the answers more than the model. Somebody whose answers the "
                             "model does not explain (p below {:g}) is judged by the number of right answers alone.",
                             options.unexplained));
    out_ += tag("p",
                "Only the lessons and the answers were used. The times until the next test assume that people "
                "forget at a rate of " +
                    fmt::format("{:g}", options.forgetting) + " radians per period (--forgetting).");
  }

  const Atlas& atlas_;
  const Domain& domain_;
  const AuditReport& report_;
  const std::string& program_;
  std::optional<BoardSvg> boards_;
  std::string out_;
};

}  // namespace

std::string audit_page(const Atlas& atlas, const AuditReport& report, const std::string& program) {
  return Page{atlas, report, program}.text();
}

}  // namespace kith
