#pragma once

#include <gtest/gtest.h>

#include <string>

#include "atlases.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/question.hpp"

namespace kith::testing {

inline Reply ask(const std::string& question, const std::string& domain = "item-delivery") {
  return answer_question(atlas_of(domain), question);
}

// "ID COLUMN" of what is wrong with a question, and the hint.
inline std::string complaint(const std::string& question, const std::string& domain = "item-delivery") {
  try {
    static_cast<void>(ask(question, domain));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    const auto& d = error.diagnostics().at(0);
    EXPECT_EQ(d.file, "question");
    EXPECT_EQ(d.source_line, question);
    return d.id + " " + std::to_string(d.column) + ": " + d.message + " | " + d.hint;
  }
  return "answered";
}

}  // namespace kith::testing
