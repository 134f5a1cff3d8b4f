// Sessions, and simulated people to be taught in them.
#include <atomic>
#include <optional>
#include <utility>

#include "arrays.hpp"
#include "assignment.hpp"
#include "belief.hpp"
#include "domain.hpp"
#include "errors.hpp"
#include "kith/learners/run_period.hpp"
#include "kith/study/team_streams.hpp"
#include "records.hpp"

namespace kith::python {
namespace {

// An object is used by one call at a time: a second thread, or code that the call itself calls, is refused.
class Use {
 public:
  Use(std::atomic<bool>& flag, const char* what) : flag_{flag} {
    if (flag_.exchange(true))
      throw Error{ErrorKind::kBusy,
                  std::string{what} + " is in use, by another thread or by the call that asks for it"};
  }
  ~Use() { flag_ = false; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  std::atomic<bool>& flag_;
};

// Lessons that the caller puts together. The demonstrations wait here during propose(); a proposal without any is made
// by the session itself.
thread_local std::optional<std::vector<StartIndex>> by_hand;

class ByHand final : public Strategy {
 public:
  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<ByHand>(*this); }
  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    const auto source = SourceBelief::of_everybody();
    if (!by_hand || by_hand->empty()) return {source, {}};
    return {source, picked_unit(select.cache(), view.taught_region, *by_hand, nullptr, select.options(), random)};
  }
};

constexpr std::string_view kByHand = "by-hand";
StrategyChoice by_hand_choice() {
  const StrategyKind kind{
      kByHand, "show what the caller says",
      [](const ParameterValues&) { return TeamBeliefNeeds{.members = true, .rules = {}}; },
      [](const ParameterValues&) -> std::unique_ptr<Strategy> { return std::make_unique<ByHand>(); }};
  return {std::string{kByHand}, kind, {}};
}

class OwnSession;

// Simulated people.
class People {
 public:
  People(DomainPointer domain, Learners learners) : domain_{std::move(domain)}, learners_{std::move(learners)} {}
  People(const People& other) : domain_{other.domain_} {
    const Use use{other.in_use_, "this group of people"};
    for (const auto& learner : other.learners_) learners_.push_back(learner->clone());
  }
  People& operator=(const People&) = delete;

  [[nodiscard]] const DomainPointer& domain() const noexcept { return domain_; }
  [[nodiscard]] std::size_t size() const noexcept { return learners_.size(); }
  template <typename Body>
  auto use(Body body) {
    const Use use{in_use_, "this group of people"};
    return body(learners_);
  }

 private:
  DomainPointer domain_;
  Learners learners_;
  mutable std::atomic<bool> in_use_{false};
};

class OwnSession {
 public:
  OwnSession(DomainPointer domain, Session session) : domain_{std::move(domain)}, session_{std::move(session)} {}
  OwnSession(const OwnSession& other) : domain_{other.domain_}, session_{other.read()} {}
  OwnSession& operator=(const OwnSession&) = delete;

  [[nodiscard]] const DomainPointer& domain() const noexcept { return domain_; }
  // A copy, since code in Python may change the session while it looks at a part of it.
  template <typename Body>
  auto use(Body body) {
    const Use use{in_use_, "this session"};
    return body(session_);
  }
  template <typename Body>
  auto look(Body body) const {
    const Use use{in_use_, "this session"};
    return body(session_);
  }
  void require_member(std::size_t member) const {
    if (member >= session_.num_members())
      throw py::index_error{"there is no member " + std::to_string(member) + "; seats are counted from 0"};
  }

 private:
  [[nodiscard]] const Session& read() const {
    if (in_use_)
      throw Error{ErrorKind::kBusy, "this session is in use, by another thread or by the call that asks for it"};
    return session_;
  }

  DomainPointer domain_;
  Session session_;
  mutable std::atomic<bool> in_use_{false};
};

std::vector<RandomStream> persons_of(const Assignment& team) {
  const auto stream = team_stream(team.spec, team.address);
  std::vector<RandomStream> persons;
  for (std::size_t i = 1; i <= team.address.composition.size(); ++i) persons.push_back(person_stream(stream, i));
  return persons;
}

std::shared_ptr<OwnSession> make_session(const DomainPointer& domain, const std::string& group, std::size_t members,
                                         const std::string& strategy, std::uint64_t seed, const std::string& study,
                                         const std::string& text, const std::vector<std::string>& overrides) {
  const bool manual = strategy == kByHand;
  const auto team =
      assignment_of(domain->domain(), group, members, manual ? "common" : strategy, seed, {study, text, overrides});
  const auto persons = persons_of(team);
  std::vector<RandomStream> beliefs;
  for (const auto& person : persons) beliefs.push_back(belief_stream(person));
  auto options = team.spec.teaching;
  options.keep_members = options.keep_rules = true;
  const bool alone = strategy == kBaseline;
  const auto teacher =
      alone ? lone_teacher_stream(persons.front()) : teacher_stream(team_stream(team.spec, team.address));
  const auto choice = manual ? by_hand_choice() : strategy_of(team.spec, strategy);
  const auto cache = domain->borrow();
  return std::make_shared<OwnSession>(domain, Session{*cache, options, choice, beliefs, teacher});
}

std::shared_ptr<People> make_people(const DomainPointer& domain, const std::string& group, std::uint64_t seed,
                                    const std::string& study, const std::string& text,
                                    const std::vector<std::string>& overrides) {
  const auto team = assignment_of(domain->domain(), group, 0, "common", seed, {study, text, overrides});
  const auto cache = domain->borrow();
  Learners learners;
  const auto persons = persons_of(team);
  for (std::size_t i = 0; i < persons.size(); ++i) {
    const auto& type = learner_type(team.spec, team.address.composition[i]);
    learners.push_back(make_learner(team.spec, type, draw_traits(type, persons[i]), persons[i], *cache));
  }
  return std::make_shared<People>(domain, std::move(learners));
}

void require_same(const OwnSession& session, const People& people) {
  if (session.domain() != people.domain()) throw py::value_error{"the people are those of another domain"};
}

bool propose(OwnSession& self, const py::object& demonstrations, const std::shared_ptr<People>& people) {
  const auto cache = self.domain()->borrow();
  std::optional<std::vector<StartIndex>> chosen;
  if (!demonstrations.is_none()) {
    chosen.emplace();
    for (const auto& start : py::iterable{demonstrations}) chosen->push_back(self.domain()->candidate_of(start));
  }
  if (people) require_same(self, *people);
  return self.use([&](Session& session) {
    if (chosen && session.strategy().kind.name != kByHand)
      throw py::value_error{"demonstrations are given to sessions with strategy='by-hand' only"};
    if (session.strategy().kind.needs_truth && !people)
      throw py::value_error{"this strategy sees into simulated people: pass them as `people`"};
    const py::gil_scoped_release unlocked;
    struct Chosen {
      ~Chosen() { by_hand.reset(); }
    } const cleared;
    by_hand = std::move(chosen);
    if (!people || !session.strategy().kind.needs_truth) return session.propose(*cache);
    return people->use([&](Learners& learners) {
      if (learners.size() != session.num_members()) throw std::invalid_argument{"there must be one person per seat"};
      return session.propose(*cache, truth_about(session, learners));
    });
  });
}

void answer(OwnSession& self, std::size_t member, const py::iterable& answers) {
  self.require_member(member);
  std::vector<Answer> list;
  for (const auto& answer : answers) {
    list.push_back(answer.is_none() ? Answer{} : Answer{counts_of(self.domain()->domain(), answer)});
  }
  self.use([&](Session& session) { session.answer(member, std::move(list)); });
}

void run(OwnSession& self, People& people) {
  require_same(self, people);
  const auto cache = self.domain()->borrow();
  self.use([&](Session& session) {
    people.use([&](Learners& learners) {
      const py::gil_scoped_release unlocked;
      (void)run_period(session, *cache, learners);
    });
  });
}

// What a person answers to the tests of the session's lesson, after watching it.
py::list answers(People& self, OwnSession& session, std::size_t member) {
  require_same(session, self);
  session.require_member(member);
  if (member >= self.size()) throw py::index_error{"there is no such person"};
  const auto cache = session.domain()->borrow();
  const auto response = session.look([&](const Session& taught) {
    const auto& lesson = taught.lesson();
    return self.use([&](Learners& learners) {
      const py::gil_scoped_release unlocked;
      if (begins_component(taught)) learners[member]->begin_component();
      watch_lesson(*learners[member], lesson, *cache);
      std::vector<StartIndex> tests;
      for (const auto& test : lesson.tests) tests.push_back(test.start);
      return learners[member]->answer(cache->behaviours(), tests, lesson.period);
    });
  });
  py::list list;
  for (const auto& answer : response.answers)
    list.append(answer ? py::object{counts_to_tuple(session.domain()->domain(), *answer)} : py::none());
  return list;
}

// The person hears the feedback of the session's last period.
void hear(People& self, const OwnSession& session, std::size_t member) {
  require_same(session, self);
  session.require_member(member);
  if (member >= self.size()) throw py::index_error{"there is no such person"};
  session.look([&](const Session& taught) {
    if (taught.history().empty()) throw py::value_error{"no period has ended yet"};
    const auto& last = taught.history().back();
    self.use([&](Learners& learners) {
      const py::gil_scoped_release unlocked;
      learners[member]->hear_feedback(last.feedback.all_correct[member], last.feedback.half_spaces, last.lesson.period);
    });
  });
}

py::object belief(const OwnSession& self, const py::object& whose) {
  return self.look([&](const Session& session) -> py::object {
    if (py::isinstance<py::str>(whose)) {
      const auto rule = whose.cast<std::string>();
      if (find_aggregation_rule(rule) == nullptr) throw py::value_error{"there is no belief '" + rule + "'"};
      return py::cast(copy_of(session.belief().aggregate(rule)));
    }
    const auto member = whose.cast<std::size_t>();
    self.require_member(member);
    return py::cast(copy_of(session.belief().member(member)));
  });
}

std::vector<double> knowledge(People& self) {
  const auto atlas = self.domain()->atlas();
  return self.use([&](Learners& learners) {
    const py::gil_scoped_release unlocked;
    std::vector<double> masses;
    for (const auto& learner : learners) masses.push_back(learner->mass_in(atlas->policy_bec_half_spaces()));
    return masses;
  });
}

const char* name_of_phase(SessionPhase phase) {
  switch (phase) {
    case SessionPhase::kProposal:
      return "proposal";
    case SessionPhase::kLesson:
      return "lesson";
    case SessionPhase::kTests:
      return "tests";
    case SessionPhase::kFeedback:
      return "feedback";
    case SessionPhase::kFinished:
      return "finished";
  }
  return "finished";
}

// One event without arguments, or of one member.
template <typename Event>
auto event(Event apply) {
  return [apply](OwnSession& self) { self.use([&](Session& session) { apply(session); }); };
}
template <typename Event>
auto member_event(Event apply) {
  return [apply](OwnSession& self, std::size_t member) {
    self.require_member(member);
    self.use([&](Session& session) { (session.*apply)(member); });
  };
}

}  // namespace

void bind_session(py::module_& module) {
  py::class_<OwnSession, std::shared_ptr<OwnSession>> session(module, "Session");
  py::class_<People, std::shared_ptr<People>> people(module, "People");
  session
      .def(py::init(&make_session), py::arg("domain"), py::arg("group"), py::arg("members"), py::arg("strategy"),
           py::arg("seed"), py::arg("study"), py::arg("text"), py::arg("overrides"))
      .def("copy", [](const OwnSession& self) { return std::make_shared<OwnSession>(self); })
      .def("propose", &propose, py::arg("demonstrations") = py::none(), py::arg("people") = nullptr)
      .def("show", event([](Session& session_) { session_.show(); }))
      .def("answer", &answer, py::arg("member"), py::arg("answers"))
      .def("close_tests",
           [](OwnSession& self) {
             return to_python(*self.domain()->atlas(),
                              self.use([](Session& taught) -> Feedback { return taught.close_tests(); }));
           })
      .def("give_feedback",
           [](OwnSession& self) {
             return to_python(*self.domain()->atlas(),
                              self.use([](Session& taught) -> Feedback { return taught.give_feedback(); }));
           })
      .def("leave", member_event(&Session::leave), py::arg("member"))
      .def("come_back", member_event(&Session::come_back), py::arg("member"))
      .def("replace", member_event(&Session::replace), py::arg("member"))
      .def("run_period", &run, py::arg("people"))
      .def_property_readonly("lesson",
                             [](const OwnSession& self) {
                               const auto lesson =
                                   self.look([](const Session& taught) -> Lesson { return taught.lesson(); });
                               return to_python(*self.domain()->atlas(), lesson);
                             })
      .def_property_readonly("history",
                             [](const OwnSession& self) {
                               const auto history =
                                   self.look([](const Session& taught) -> PastPeriods { return taught.history(); });
                               const auto atlas = self.domain()->atlas();
                               py::list list;
                               for (const auto& period : history) list.append(to_python(*atlas, period));
                               return list;
                             })
      .def("belief", &belief, py::arg("whose"))
      .def(
          "takes_part",
          [](const OwnSession& self, std::size_t member) {
            self.require_member(member);
            return self.look([&](const Session& taught) { return taught.takes_part(member); });
          },
          py::arg("member"))
      .def(
          "has_answered",
          [](const OwnSession& self, std::size_t member) {
            self.require_member(member);
            return self.look([&](const Session& taught) { return taught.has_answered(member); });
          },
          py::arg("member"))
      .def_property_readonly("phase",
                             [](const OwnSession& self) {
                               return self.look([](const Session& taught) { return name_of_phase(taught.phase()); });
                             })
      .def_property_readonly(
          "status",
          [](const OwnSession& self) {
            return self.look([](const Session& taught) { return std::string{name_of(taught.status())}; });
          })
      .def_property_readonly(
          "periods",
          [](const OwnSession& self) { return self.look([](const Session& taught) { return taught.periods(); }); })
      .def_property_readonly(
          "num_members",
          [](const OwnSession& self) { return self.look([](const Session& taught) { return taught.num_members(); }); })
      .def_property_readonly("components",
                             [](const OwnSession& self) {
                               return self.look([](const Session& taught) {
                                 py::list list;
                                 for (const auto status : taught.components())
                                   list.append(status == ComponentStatus::kLearned   ? "learned"
                                               : status == ComponentStatus::kSkipped ? "skipped"
                                                                                     : "open");
                                 return list;
                               });
                             })
      .def_property_readonly("events",
                             [](const OwnSession& self) {
                               return self.look([](const Session& taught) {
                                 py::list list;
                                 for (const auto& event : taught.events()) list.append(std::string{name_of(event)});
                                 return list;
                               });
                             })
      .def("__eq__",
           [](const OwnSession& self, const OwnSession& other) {
             if (&self == &other) return true;
             const auto mine = self.domain(), theirs = other.domain();
             if (mine != theirs && (mine->text() != theirs->text() || mine->files() != theirs->files())) return false;
             return self.look([&](const Session& a) { return other.look([&](const Session& b) { return a == b; }); });
           })
      .def("__eq__", [](const OwnSession&, const py::object&) { return false; });
  people
      .def(py::init(&make_people), py::arg("domain"), py::arg("group"), py::arg("seed"), py::arg("study"),
           py::arg("text"), py::arg("overrides"))
      .def("copy", [](const People& self) { return std::make_shared<People>(self); })
      .def("__len__", &People::size)
      .def("answers", &answers, py::arg("session"), py::arg("member"))
      .def("hear_feedback", &hear, py::arg("session"), py::arg("member"))
      .def_property_readonly("knowledge", &knowledge)
      .def(
          "belief",
          [](People& self, std::size_t member) -> std::optional<Belief> {
            if (member >= self.size()) throw py::index_error{"there is no such person"};
            return self.use([&](Learners& learners) -> std::optional<Belief> {
              const auto* own = learners[member]->belief();
              return own == nullptr ? std::nullopt : std::optional{copy_of(*own)};
            });
          },
          py::arg("member"));
}

}  // namespace kith::python
