#include "kith/explain/question.hpp"

#include "answerer.hpp"
#include "question_parser.hpp"

namespace kith {

Reply answer_question(const Atlas& atlas, const std::string& question) {
  return detail::Answerer{atlas, question, detail::parse_question(atlas.domain(), question)}.reply();
}

}  // namespace kith
