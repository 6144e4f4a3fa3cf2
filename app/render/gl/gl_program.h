// SPDX-License-Identifier: Apache-2.0
// A linked pair of shaders.
#pragma once

#include <string>

#include "app/render/gl/gl_objects.h"
#include "platform/error.h"

namespace relievo {

class GlProgram {
 public:
  GlProgram() noexcept = default;  // of no use until assigned

  // `defines` is put before both sources, behind the version line. What the driver's compiler says goes to the log.
  [[nodiscard]] static Result<GlProgram> create(const std::string& defines, const char* vertex_source,
                                                const char* fragment_source);
  void use() const noexcept { glUseProgram(name_.get()); }
  // -1, which every glUniform ignores, for one that the compiler has optimised away.
  [[nodiscard]] GLint uniform(const char* name) const noexcept { return glGetUniformLocation(name_.get(), name); }

 private:
  GlProgramName name_;
};

}  // namespace relievo
