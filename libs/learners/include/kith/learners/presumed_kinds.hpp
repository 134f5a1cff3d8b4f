#pragma once

#include <string>
#include <vector>

#include "kith/learners/learner_model.hpp"
#include "kith/teaching/learner_hypothesis.hpp"

namespace kith {

/// The kinds that hypotheses can be about: those of the models with the traits of "bayesian", in their order.
[[nodiscard]] std::vector<std::string> presumable_kinds(LearnerModels models = learner_models());

/// Hypotheses about people of these kinds, all kinds equally probable: each with two abilities and with the defaults of
/// the kind's parameters; of a parameter in LearnerModel::fitted that is a whole number, with all its values, as there
/// is no usual one. Answers are rated as the kind gives them (Learner::likelihood()) with AnswerFit::slip(). Where
/// behaviours are not tabulated all kinds are taken to answer as they believe, so that only kinds are told apart that
/// believe something else.
/// @param kinds  some of presumable_kinds(). @param models  have to stay while the hypotheses are used.
[[nodiscard]] std::vector<LearnerHypothesis> hypotheses_about_kinds(const std::vector<std::string>& kinds,
                                                                    LearnerModels models = learner_models());

}  // namespace kith
