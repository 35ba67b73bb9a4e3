#include "tests/llvmpipe/gl_renderer.h"

#define EGL_EGLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <fmt/format.h>

#include <array>

#include "model/command/load_program.h"
#include "model/error.h"
#include "model/isa/program.h"
#include "tests/llvmpipe/glsl.h"

namespace splatscope::llvmpipe {
namespace {

void expect(bool holds, const char* what) {
  if (!holds) throw ModelError(fmt::format("no software renderer: {} failed", what));
}

void make_context() {
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  expect(get_display != nullptr, "eglGetPlatformDisplayEXT");
  const EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  expect(eglInitialize(display, nullptr, nullptr) == EGL_TRUE, "eglInitialize");
  eglBindAPI(EGL_OPENGL_ES_API);
  constexpr EGLint kConfig[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  expect(eglChooseConfig(display, kConfig, &config, 1, &count) == EGL_TRUE && count > 0, "eglChooseConfig");
  constexpr EGLint kContext[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, kContext);
  expect(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE, "eglMakeCurrent");
}

void make_frame(const Trace& trace) {
  const auto width = static_cast<GLsizei>(trace.width), height = static_cast<GLsizei>(trace.height);
  GLuint frame = 0;
  std::array<GLuint, 2> surfaces{};
  glGenFramebuffers(1, &frame);
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glGenRenderbuffers(2, surfaces.data());
  glBindRenderbuffer(GL_RENDERBUFFER, surfaces[0]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, surfaces[0]);
  glBindRenderbuffer(GL_RENDERBUFFER, surfaces[1]);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, surfaces[1]);
  expect(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "glCheckFramebufferStatus");
  glViewport(0, 0, width, height);
}

GLuint compile(GLenum kind, const std::string& text) {
  const GLuint shader = glCreateShader(kind);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::array<char, 2000> log{};
  glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
  throw ModelError(fmt::format("a shader does not compile: {}\n{}", log.data(), text));
}

GLuint link(const std::string& vertex_shader, const std::string& fragment_shader) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, vertex_shader));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragment_shader));
  for (GLuint input = 0; input < 6; ++input)
    glBindAttribLocation(program, input, fmt::format("v{}", input).c_str());
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  expect(linked == GL_TRUE, "glLinkProgram");
  return program;
}

struct GlFormat {
  GLint components;
  GLenum type;
  GLboolean normalized;
};

GlFormat format_of(VertexFormat format) {
  switch (format) {
    case VertexFormat::float1:
      return {1, GL_FLOAT, GL_FALSE};
    case VertexFormat::float2:
      return {2, GL_FLOAT, GL_FALSE};
    case VertexFormat::float3:
      return {3, GL_FLOAT, GL_FALSE};
    case VertexFormat::float4:
      return {4, GL_FLOAT, GL_FALSE};
    case VertexFormat::d3dcolor:  // blue first: read() swaps it back
      return {4, GL_UNSIGNED_BYTE, GL_TRUE};
    default:
      throw ModelError("not a format that splatting uses");
  }
}

void set(GLenum capability, bool on) {
  on ? glEnable(capability) : glDisable(capability);
}

}  // namespace

GlRenderer::GlRenderer(const Trace& trace) : trace_(trace) {
  make_context();
  make_frame(trace);
  buffers_.resize(trace.buffers.size());
  glGenBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    const auto& bytes = trace.buffers[i].bytes;
    glBindBuffer(GL_ARRAY_BUFFER, buffers_[i]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STATIC_DRAW);
  }
  textures_.resize(trace.textures.size());
  glGenTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t i = 0; i < textures_.size(); ++i) {
    const Texture& texture = trace.textures[i];
    glBindTexture(GL_TEXTURE_2D, textures_[i]);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_ALPHA, static_cast<GLsizei>(texture.width),
                 static_cast<GLsizei>(texture.height), 0, GL_ALPHA, GL_UNSIGNED_BYTE, texture.texels.data());
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
      glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  }
  programs_.resize(trace.programs.size());
  for (const Command& command : trace.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr || programs_[draw->vertex_program] != 0) continue;
    programs_[draw->vertex_program] =
        link(vertex_shader(load_program(trace.programs[draw->vertex_program])),
             draw->state.color_write ? splat_fragment_shader() : empty_fragment_shader());
  }
}

void GlRenderer::draw() const {
  for (const Command& command : trace_.commands) std::visit([&](const auto& body) { run(body); }, command);
  glFinish();
}

void GlRenderer::run(const NormalizeOnHost&) const {
  throw ModelError("the host's normalisation is not drawn");
}

void GlRenderer::run(const Clear& clear) const {
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearColor(clear.color[2], clear.color[1], clear.color[0], clear.color[3]);
  glClearDepthf(clear.depth);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void GlRenderer::run(const Draw& draw) const {
  if (draw.target != 0 || draw.source) throw ModelError("off-screen surfaces are not drawn");
  const DrawState& state = draw.state;
  set(GL_DEPTH_TEST, state.depth_test);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(state.depth_write ? GL_TRUE : GL_FALSE);
  const GLboolean colors = state.color_write ? GL_TRUE : GL_FALSE;
  glColorMask(colors, colors, colors, colors);
  set(GL_BLEND, state.blend);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE);
  const GLuint program = programs_[draw.vertex_program];
  glUseProgram(program);
  glUniform4fv(glGetUniformLocation(program, "c"), static_cast<GLsizei>(draw.constants.size()),
               draw.constants[0].data());
  glUniform2f(glGetUniformLocation(program, "pixel"), 1.0f / static_cast<float>(trace_.width),
              1.0f / static_cast<float>(trace_.height));
  if (draw.texture) glBindTexture(GL_TEXTURE_2D, textures_[*draw.texture]);
  glBindBuffer(GL_ARRAY_BUFFER, buffers_[draw.vertex_buffer]);
  for (const VertexAttribute& attribute : draw.attributes) {
    const GlFormat format = format_of(attribute.format);
    const std::size_t offset = std::size_t{draw.base_vertex} * draw.vertex_stride + attribute.offset;
    glEnableVertexAttribArray(attribute.input);
    glVertexAttribPointer(attribute.input, format.components, format.type, format.normalized,
                          static_cast<GLsizei>(draw.vertex_stride), reinterpret_cast<const void*>(offset));
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[draw.index_buffer]);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(draw.index_count), GL_UNSIGNED_SHORT,
                 reinterpret_cast<const void*>(std::size_t{draw.first_index} * sizeof(std::uint16_t)));
}

std::vector<std::uint8_t> GlRenderer::read() const {
  std::vector<std::uint8_t> pixels(std::size_t{trace_.width} * trace_.height * 4);
  glReadPixels(0, 0, static_cast<GLsizei>(trace_.width), static_cast<GLsizei>(trace_.height), GL_RGBA,
               GL_UNSIGNED_BYTE, pixels.data());
  for (std::size_t i = 0; i < pixels.size(); i += 4) std::swap(pixels[i], pixels[i + 2]);
  return pixels;
}

const char* GlRenderer::name() const {
  return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

}  // namespace splatscope::llvmpipe
