// SPDX-License-Identifier: Apache-2.0
// A linked vertex and fragment shader.
#pragma once

#include <string>

#include "app/render/gl/gl_objects.h"
#include "platform/error.h"

namespace relievo {

class GlProgram {
 public:
  GlProgram() noexcept = default;  // unusable until assigned

  // `defines` is inserted into both sources after the version line. The driver's compiler messages go to the log.
  [[nodiscard]] static Result<GlProgram> create(const std::string& defines, const char* vertex_source,
                                                const char* fragment_source);
  void use() const noexcept { glUseProgram(name_.get()); }
  // -1, which glUniform* ignores, if the compiler has removed it.
  [[nodiscard]] GLint uniform(const char* name) const noexcept { return glGetUniformLocation(name_.get(), name); }

 private:
  GlProgramName name_;
};

}  // namespace relievo
