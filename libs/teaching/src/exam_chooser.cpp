#include "kith/teaching/exam_chooser.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "kith/core/math.hpp"

namespace kith {
namespace {

double entropy_term(double p) { return p > 0.0 ? -p * math::log(p) : 0.0; }

// -sum p log p of parts that sum to `all`, times all once they are divided by it.
template <typename Parts>
double entropy_of(const Parts& parts) {
  double all = 0.0, sum = 0.0;
  for (const double part : parts) {
    all += part;
    sum += entropy_term(part);
  }
  return sum - entropy_term(all);
}

// What can be said of somebody and a component: that they understand it, or why not.
constexpr std::size_t kKinds = 4;
using Kinds = std::array<double, kKinds>;

std::size_t kind_without_understanding(PossiblePerson::Kind kind) {
  switch (kind) {
    case PossiblePerson::Kind::kMisconceives:
      return 1;
    case PossiblePerson::Kind::kLearns:
    case PossiblePerson::Kind::kDoesNotLearn:
      return 2;
    case PossiblePerson::Kind::kGuesses:
      break;
  }
  return 3;
}

}  // namespace

ExamChooser::ExamChooser(TeachingCache& cache, const std::function<bool(StartIndex)>& is_usable)
    : atlas_{&cache.atlas()} {
  std::vector<StartIndex> starts;
  if (atlas_->find_tables()) {
    for (StartIndex start{0}; start.value() < atlas_->num_states(); ++start) starts.push_back(start);
  } else {
    for (std::size_t k = 0; k < atlas_->knowledge_components().size(); ++k) {
      for (const auto& sample : {cache.starts_of(k), cache.tests_of(k)}) {
        for (std::size_t i = 0; i < sample->size(); ++i) starts.push_back(sample->start(i));
      }
    }
    std::sort(starts.begin(), starts.end());
    starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  }
  std::erase_if(starts,
                [&](StartIndex start) { return !atlas_->is_candidate(start) || (is_usable && !is_usable(start)); });
  gather(starts);
}

void ExamChooser::gather(std::span<const StartIndex> starts) {
  const auto* tables = atlas_->find_tables();
  std::map<std::pair<HullIndex, std::vector<HalfSpace>>, std::size_t> known;
  for (const auto start : starts) {
    Question question;
    if (tables) {
      question.hull = tables->hull(start);
      question.answers = tables->hull(question.hull).losses.size() + 1;  // the last: a path that is best for nobody
      if (question.answers < 3) continue;
    } else {
      question.examined = atlas_->constraints().half_spaces(atlas_->tested_constraints(start).without(atlas_->prior()));
      if (question.examined.empty()) continue;
    }
    const auto [place, is_new] = known.try_emplace({question.hull, question.examined}, questions_.size());
    if (is_new) {
      question.first = num_answers_;
      num_answers_ += question.answers;
      questions_.push_back(std::move(question));
    }
    questions_[place->second].starts.push_back(start);
  }
  for (auto& question : questions_) {
    std::sort(question.starts.begin(), question.starts.end(), [&](StartIndex a, StartIndex b) {
      return std::pair{atlas_->complexity(b), b} < std::pair{atlas_->complexity(a), a};
    });
  }
}

void ExamChooser::leave_out(StartIndex start) {
  const auto looks_like_it = [&](StartIndex other) {
    return other == start || atlas_->trajectory_class(other) == atlas_->trajectory_class(start);
  };
  for (auto& question : questions_) std::erase_if(question.starts, looks_like_it);
}

// The probabilities of the answers to all questions, as AnswerFit has them.
std::vector<double> ExamChooser::answers_of(const PossiblePerson& person) const {
  std::vector<double> answers(num_answers_, 0.0);
  if (person.belief == nullptr) {
    add_guesses(person.guess, answers);
  } else if (atlas_->find_tables()) {
    add_answers_by_cell(person.belief->cell_masses(*atlas_), answers);
  } else {
    for (const auto& question : questions_) {
      const double right = person.belief->belief().mass_in(question.examined);
      answers[question.first] =
          AnswerFit::slip() * AnswerFit::chance() + (1.0 - AnswerFit::slip()) * std::min(right, 1.0);
      answers[question.first + 1] = 1.0 - answers[question.first];
    }
  }
  return answers;
}

void ExamChooser::add_guesses(AnswerFit::Guess guess, std::vector<double>& answers) const {
  const double nobodys = AnswerFit::best_for_nobody(guess);
  for (const auto& question : questions_) {
    const bool by_two = !atlas_->find_tables();
    const auto last = question.first + question.answers - 1;
    for (auto a = question.first; a < last; ++a) {
      answers[a] = by_two ? AnswerFit::chance() : (1.0 - nobodys) / static_cast<double>(question.answers - 1);
    }
    answers[last] = by_two ? 1.0 - AnswerFit::chance() : nobodys;
  }
}

void ExamChooser::add_answers_by_cell(std::span<const double> masses, std::vector<double>& answers) const {
  const auto& cells = atlas_->tables().cells();
  for (std::size_t c = 0; c < masses.size(); ++c) {
    if (masses[c] == 0.0) continue;
    for (const auto& question : questions_) {
      const auto choice = cells.choice(PolicyCellIndex{c}, question.hull);
      if (choice != PolicyCells::kNone) answers[question.first + choice] += masses[c];
    }
  }
  for (const auto& question : questions_) {
    const auto begin = answers.begin() + static_cast<std::ptrdiff_t>(question.first);
    const auto end = begin + static_cast<std::ptrdiff_t>(question.answers);
    const double any = std::accumulate(begin, end, 0.0);
    const double chance = AnswerFit::slip() / static_cast<double>(question.answers);
    const double scale = any > 0.0 ? (1.0 - AnswerFit::slip()) / any : 0.0;
    for (auto at = begin; at != end; ++at)
      *at = any > 0.0 ? chance + scale * *at : 1.0 / static_cast<double>(question.answers);
  }
}

std::optional<StartIndex> ExamChooser::choose(const MisconceptionBank& bank,
                                              std::span<const std::vector<HalfSpace>> components,
                                              const CredibleLevelOptions& level) {
  constexpr double kLeastWeight = 1e-4, kNothing = 1e-9, kAsMuch = 1.0 - 1e-9;
  const auto people = bank.possible_people(kLeastWeight);
  std::vector<std::vector<double>> guesses;
  guesses.reserve(people.size());
  std::vector<const double*> answers;            // per person
  std::vector<std::vector<double>> understands;  // per component and person
  for (const auto& person : people) {
    if (person.belief == nullptr) {
      answers.push_back(guesses.emplace_back(answers_of(person)).data());
      continue;
    }
    auto known = known_.find(person.belief);
    if (known == known_.end()) known = known_.emplace(person.belief, answers_of(person)).first;
    answers.push_back(known->second.data());
  }
  for (const auto& component : components) {
    auto& row = understands.emplace_back();
    for (const auto& person : people) {
      row.push_back(person.belief == nullptr ? 0.0 : probability_of_enough(person.belief->mass_in(component), level));
    }
  }

  const Question* best = nullptr;
  double most = kNothing;
  for (const auto& question : questions_) {
    if (question.starts.empty()) continue;
    double tells = 0.0;
    for (const auto& row : understands) {
      Kinds before{};
      std::vector<Kinds> after(question.answers, Kinds{});
      for (std::size_t i = 0; i < people.size(); ++i) {
        const std::array parts{people[i].weight * row[i], people[i].weight * (1.0 - row[i])};
        const std::array kinds{std::size_t{0}, kind_without_understanding(people[i].kind)};
        for (std::size_t part = 0; part < parts.size(); ++part) {
          before[kinds[part]] += parts[part];
          for (std::size_t a = 0; a < after.size(); ++a) {
            after[a][kinds[part]] += parts[part] * answers[i][question.first + a];
          }
        }
      }
      tells += entropy_of(before);
      for (const auto& kinds : after) tells -= entropy_of(kinds);
    }
    const auto simplicity = [&](const Question& one) { return atlas_->complexity(one.starts.back()); };
    const bool is_better = tells * kAsMuch > most;
    const bool is_simpler = best != nullptr && tells >= most * kAsMuch && simplicity(question) < simplicity(*best);
    if (!is_better && !is_simpler) continue;
    best = &question;
    most = std::max(most, tells);
  }
  return best == nullptr ? std::nullopt : std::optional{best->starts.back()};
}

}  // namespace kith
