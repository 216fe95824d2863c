// OpenGL in memory through OSMesa: context, shaders, buffers, each released by its destructor.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
// after osmesa.h, which brings GL/gl.h
#include <GL/glext.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace ahm::view {

// Every function used. They are asked from OSMesa by name rather than linked, since a program that also links libGL (as
// anything with VTK does) would otherwise get libGL's functions, which know nothing of this context.
#define AHM_GL_FUNCTIONS(X)                                                                                            \
  X(glActiveTexture)                                                                                                   \
  X(glAttachShader)                                                                                                    \
  X(glBindBuffer) X(glBindFramebuffer) X(glBindRenderbuffer) X(glBindTexture) X(glBindVertexArray) X(glBlendFunc)      \
      X(glBufferData) X(glCheckFramebufferStatus) X(glClear) X(glClearColor) X(glCompileShader) X(glCreateProgram)     \
          X(glCreateShader) X(glDeleteBuffers) X(glDeleteFramebuffers) X(glDeleteProgram) X(glDeleteShader)            \
              X(glDeleteTextures) X(glDeleteVertexArrays) X(glDepthFunc) X(glDepthMask) X(glDisable) X(glDrawArrays)   \
                  X(glDrawBuffers) X(glDrawElements) X(glEnable) X(glEnableVertexAttribArray) X(glFinish)              \
                      X(glFramebufferTexture2D) X(glGenBuffers) X(glGenFramebuffers) X(glGenTextures)                  \
                          X(glGenVertexArrays) X(glGetError) X(glGetIntegerv) X(glGetProgramInfoLog) X(glGetProgramiv) \
                              X(glGetShaderInfoLog) X(glGetShaderiv) X(glGetUniformLocation) X(glLinkProgram)          \
                                  X(glPixelStorei) X(glReadBuffer) X(glReadPixels) X(glShaderSource) X(glTexImage2D)   \
                                      X(glTexParameteri) X(glUniform1f) X(glUniform1i) X(glUniform3f)                  \
                                          X(glUniformMatrix4fv) X(glUseProgram) X(glVertexAttribPointer) X(glViewport)

/// The functions of OpenGL 3.3 core.
struct GlFunctions {
#define AHM_GL_DECLARE(name) decltype(&::name) name = nullptr;
  AHM_GL_FUNCTIONS(AHM_GL_DECLARE)
#undef AHM_GL_DECLARE
};

/// A current context without a window. What was current before is made current again at the end.
class GlContext {
 public:
  /// @throws Error if OSMesa cannot give OpenGL 3.3.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  const GlFunctions& gl() const { return gl_; }
  /// @throws Error naming the step if OpenGL reported an error.
  void check(const char* step) const;

 private:
  OSMesaContext context_;
  std::vector<unsigned char> dummy_;  // OSMesa wants memory to draw to; pictures go to textures instead
  GlFunctions gl_;
};

/// A linked pair of shaders.
class GlProgram {
 public:
  GlProgram(const GlContext& context, std::string_view vertex, std::string_view fragment);
  ~GlProgram() { gl_.glDeleteProgram(program_); }
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;
  void use() const { gl_.glUseProgram(program_); }
  GLint uniform(const char* name) const { return gl_.glGetUniformLocation(program_, name); }

 private:
  const GlFunctions& gl_;
  GLuint program_;
};

/// A vertex array with its buffers.
class GlVertices {
 public:
  explicit GlVertices(const GlContext& context);
  ~GlVertices();
  GlVertices(const GlVertices&) = delete;
  GlVertices& operator=(const GlVertices&) = delete;
  /// Floats for attribute `location`, `components` per vertex.
  void attribute(GLuint location, GLint components, const float* data, std::size_t vertices);
  void triangles(const std::vector<std::uint32_t>& indices);

 private:
  GLuint buffer(GLenum target, const void* data, std::size_t bytes);

  const GlFunctions& gl_;
  GLuint array_ = 0;
  std::vector<GLuint> buffers_;
};

/// Textures to draw into: colour formats in order, and a depth texture if asked.
class GlTarget {
 public:
  GlTarget(const GlContext& context, int width, int height, std::initializer_list<GLint> formats, bool has_depth);
  /// Some colour textures of another target, which outlives this one: to draw into these while reading the others.
  GlTarget(const GlContext& context, const GlTarget& other, std::initializer_list<std::size_t> textures);
  ~GlTarget();
  GlTarget(const GlTarget&) = delete;
  GlTarget& operator=(const GlTarget&) = delete;
  /// Draws go to the colour textures whose entry is true.
  void bind(std::initializer_list<bool> enabled) const;
  /// The colour texture, to read from.
  void bind_texture(std::size_t index, GLuint unit) const;

 private:
  GLuint texture(GLint internal, GLenum format, GLenum type, GLenum attachment);

  const GlFunctions& gl_;
  int width_, height_;
  GLuint framebuffer_ = 0;
  std::vector<GLuint> textures_;
  bool owns_textures_ = true;
};

}  // namespace ahm::view
