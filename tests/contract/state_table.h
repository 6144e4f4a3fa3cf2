// SPDX-License-Identifier: Apache-2.0
// Tries every call in every state: a call that the interface's table allows must succeed, any other must change
// nothing.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "platform/error.h"

namespace relievo::test {

// A call's answer without its value: nullopt, or the error.
using Answer = std::optional<ErrorCode>;

template <class T>
[[nodiscard]] Answer answerOf(const Result<T>& result) {
  if (result) return std::nullopt;
  return result.error().code;
}

template <class Device>
struct Verb {
  std::string name;
  std::function<Answer(Device&)> call;
};

// One row: in state `from`, each verb in the order of the table's verbs leads to a state, or is forbidden.
template <class State>
struct Row {
  State from;
  std::vector<std::optional<State>> to;
};

// `bring(state)` makes a fresh device in that state, or null if this back end cannot reach it.
template <class Device, class State>
void expectStateTable(const std::vector<Verb<Device>>& verbs, const std::vector<Row<State>>& table,
                      const std::type_identity_t<std::function<std::unique_ptr<Device>(State)>>& bring) {
  for (const Row<State>& row : table) {
    ASSERT_EQ(row.to.size(), verbs.size());
    for (std::size_t i = 0; i < verbs.size(); ++i) {
      SCOPED_TRACE("verb " + verbs[i].name + " in state " + std::to_string(static_cast<int>(row.from)));
      const std::unique_ptr<Device> device = bring(row.from);
      if (device == nullptr) continue;
      ASSERT_EQ(device->state(), row.from) << "the state was not reached";
      const Answer answer = verbs[i].call(*device);
      if (row.to[i]) {
        EXPECT_EQ(answer, std::nullopt) << "it is allowed here";
        EXPECT_EQ(device->state(), *row.to[i]);
      } else {
        EXPECT_EQ(answer, ErrorCode::InvalidState) << "it is forbidden here";
        EXPECT_EQ(device->state(), row.from) << "a forbidden verb changes nothing";
      }
    }
  }
}

}  // namespace relievo::test
