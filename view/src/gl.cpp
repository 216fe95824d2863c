#include "gl.hpp"

#include <array>

#include "ahm/error.hpp"

namespace ahm::view {
namespace {

GLuint compile(const GlFunctions& gl, GLenum kind, std::string_view source) {
  const GLuint shader = gl.glCreateShader(kind);
  const char* text = source.data();
  const auto length = static_cast<GLint>(source.size());
  gl.glShaderSource(shader, 1, &text, &length);
  gl.glCompileShader(shader);
  GLint ok = 0;
  gl.glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  std::array<char, 2048> log{};
  gl.glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size() - 1), nullptr, log.data());
  gl.glDeleteShader(shader);
  throw Error(std::string("OpenGL: a shader does not compile: ") + log.data());
}

}  // namespace

GlContext::GlContext() : dummy_(4 * 16 * 16) {
  constexpr std::array<int, 13> attributes = {OSMESA_FORMAT,
                                              OSMESA_RGBA,
                                              OSMESA_DEPTH_BITS,
                                              0,
                                              OSMESA_PROFILE,
                                              OSMESA_CORE_PROFILE,
                                              OSMESA_CONTEXT_MAJOR_VERSION,
                                              3,
                                              OSMESA_CONTEXT_MINOR_VERSION,
                                              3,
                                              0,
                                              0,
                                              0};
  context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
  if (context_ == nullptr) throw Error("OSMesa: cannot create an OpenGL 3.3 context");
  bool complete = OSMesaMakeCurrent(context_, dummy_.data(), GL_UNSIGNED_BYTE, 16, 16) == GL_TRUE;
#define AHM_GL_LOAD(name)                                                       \
  gl_.name = reinterpret_cast<decltype(gl_.name)>(OSMesaGetProcAddress(#name)); \
  complete = complete && gl_.name != nullptr;
  AHM_GL_FUNCTIONS(AHM_GL_LOAD)
#undef AHM_GL_LOAD
  if (complete) return;
  OSMesaDestroyContext(context_);
  throw Error("OSMesa: OpenGL 3.3 is not complete");
}

GlContext::~GlContext() {
  OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
  OSMesaDestroyContext(context_);
}

void GlContext::check(const char* step) const {
  if (const GLenum error = gl_.glGetError(); error != GL_NO_ERROR)
    throw Error(std::string("OpenGL: error ") + std::to_string(error) + " in " + step +
                (error == GL_OUT_OF_MEMORY ? " (out of memory: ask for a smaller picture)" : ""));
}

GlProgram::GlProgram(const GlContext& context, std::string_view vertex, std::string_view fragment)
    : gl_(context.gl()), program_(gl_.glCreateProgram()) {
  for (const auto& [kind, source] : {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
    const GLuint shader = compile(gl_, static_cast<GLenum>(kind), source);
    gl_.glAttachShader(program_, shader);
    gl_.glDeleteShader(shader);  // lives on as long as the program
  }
  gl_.glLinkProgram(program_);
  GLint ok = 0;
  gl_.glGetProgramiv(program_, GL_LINK_STATUS, &ok);
  if (ok) return;
  std::array<char, 2048> log{};
  gl_.glGetProgramInfoLog(program_, static_cast<GLsizei>(log.size() - 1), nullptr, log.data());
  gl_.glDeleteProgram(program_);
  throw Error(std::string("OpenGL: shaders do not link: ") + log.data());
}

GlVertices::GlVertices(const GlContext& context) : gl_(context.gl()) {
  gl_.glGenVertexArrays(1, &array_);
  gl_.glBindVertexArray(array_);
}

GlVertices::~GlVertices() {
  gl_.glDeleteVertexArrays(1, &array_);
  gl_.glDeleteBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
}

GLuint GlVertices::buffer(GLenum target, const void* data, std::size_t bytes) {
  GLuint buffer = 0;
  gl_.glGenBuffers(1, &buffer);
  buffers_.push_back(buffer);
  gl_.glBindBuffer(target, buffer);
  gl_.glBufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
  return buffer;
}

void GlVertices::attribute(GLuint location, GLint components, const float* data, std::size_t vertices) {
  buffer(GL_ARRAY_BUFFER, data, vertices * static_cast<std::size_t>(components) * sizeof(float));
  gl_.glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, 0, nullptr);
  gl_.glEnableVertexAttribArray(location);
}

void GlVertices::triangles(const std::vector<std::uint32_t>& indices) {
  buffer(GL_ELEMENT_ARRAY_BUFFER, indices.data(), indices.size() * sizeof(std::uint32_t));
}

GlTarget::GlTarget(const GlContext& context, int width, int height, std::initializer_list<GLint> formats,
                   bool has_depth)
    : gl_(context.gl()), width_(width), height_(height) {
  gl_.glGenFramebuffers(1, &framebuffer_);
  gl_.glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  for (const GLint format : formats)
    texture(format, GL_RGBA, GL_FLOAT, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(textures_.size()));
  if (has_depth) texture(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, GL_DEPTH_ATTACHMENT);
  context.check("making a picture in memory");
  if (gl_.glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw Error("OpenGL: cannot draw into a picture of " + std::to_string(width) + " x " + std::to_string(height));
}

GlTarget::GlTarget(const GlContext& context, const GlTarget& other, std::initializer_list<std::size_t> textures)
    : gl_(context.gl()), width_(other.width_), height_(other.height_), owns_textures_(false) {
  gl_.glGenFramebuffers(1, &framebuffer_);
  gl_.glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  for (const std::size_t index : textures) {
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(textures_.size());
    gl_.glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, other.textures_[index], 0);
    textures_.push_back(other.textures_[index]);
  }
}

GlTarget::~GlTarget() {
  gl_.glDeleteFramebuffers(1, &framebuffer_);
  if (owns_textures_) gl_.glDeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
}

GLuint GlTarget::texture(GLint internal, GLenum format, GLenum type, GLenum attachment) {
  GLuint texture = 0;
  gl_.glGenTextures(1, &texture);
  textures_.push_back(texture);
  gl_.glBindTexture(GL_TEXTURE_2D, texture);
  gl_.glTexImage2D(GL_TEXTURE_2D, 0, internal, width_, height_, 0, format, type, nullptr);
  gl_.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl_.glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
  return texture;
}

void GlTarget::bind(std::initializer_list<bool> enabled) const {
  gl_.glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  std::vector<GLenum> buffers;
  for (const bool on : enabled)
    buffers.push_back(on ? GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(buffers.size()) : static_cast<GLenum>(GL_NONE));
  gl_.glDrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  gl_.glViewport(0, 0, width_, height_);
}

void GlTarget::bind_texture(std::size_t index, GLuint unit) const {
  gl_.glActiveTexture(GL_TEXTURE0 + unit);
  gl_.glBindTexture(GL_TEXTURE_2D, textures_[index]);
}

}  // namespace ahm::view
