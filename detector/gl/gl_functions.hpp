#pragma once

#include <GL/glcorearb.h>

namespace vestige {

// Every OpenGL entry point that the program calls. They are loaded from the context's own library, so nothing links
// libGL.
#define VESTIGE_GL_FUNCTIONS(X)                                          \
  X(PFNGLATTACHSHADERPROC, AttachShader)                                 \
  X(PFNGLBEGINQUERYPROC, BeginQuery)                                     \
  X(PFNGLBEGINTRANSFORMFEEDBACKPROC, BeginTransformFeedback)             \
  X(PFNGLBINDBUFFERPROC, BindBuffer)                                     \
  X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)                             \
  X(PFNGLBINDBUFFERRANGEPROC, BindBufferRange)                           \
  X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)                           \
  X(PFNGLBINDTEXTUREUNITPROC, BindTextureUnit)                           \
  X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)                           \
  X(PFNGLCHECKNAMEDFRAMEBUFFERSTATUSPROC, CheckNamedFramebufferStatus)   \
  X(PFNGLCLEARNAMEDFRAMEBUFFERFVPROC, ClearNamedFramebufferfv)           \
  X(PFNGLCLEARNAMEDFRAMEBUFFERUIVPROC, ClearNamedFramebufferuiv)         \
  X(PFNGLCLIENTWAITSYNCPROC, ClientWaitSync)                             \
  X(PFNGLCLIPCONTROLPROC, ClipControl)                                   \
  X(PFNGLCOMPILESHADERPROC, CompileShader)                               \
  X(PFNGLCOPYNAMEDBUFFERSUBDATAPROC, CopyNamedBufferSubData)             \
  X(PFNGLCREATEBUFFERSPROC, CreateBuffers)                               \
  X(PFNGLCREATEFRAMEBUFFERSPROC, CreateFramebuffers)                     \
  X(PFNGLCREATEPROGRAMPROC, CreateProgram)                               \
  X(PFNGLCREATEQUERIESPROC, CreateQueries)                               \
  X(PFNGLCREATERENDERBUFFERSPROC, CreateRenderbuffers)                   \
  X(PFNGLCREATESHADERPROC, CreateShader)                                 \
  X(PFNGLCREATETEXTURESPROC, CreateTextures)                             \
  X(PFNGLCREATEVERTEXARRAYSPROC, CreateVertexArrays)                     \
  X(PFNGLDEBUGMESSAGECALLBACKPROC, DebugMessageCallback)                 \
  X(PFNGLDEBUGMESSAGECONTROLPROC, DebugMessageControl)                   \
  X(PFNGLDEBUGMESSAGEINSERTPROC, DebugMessageInsert)                     \
  X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                               \
  X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)                     \
  X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                               \
  X(PFNGLDELETEQUERIESPROC, DeleteQueries)                               \
  X(PFNGLDELETERENDERBUFFERSPROC, DeleteRenderbuffers)                   \
  X(PFNGLDELETESHADERPROC, DeleteShader)                                 \
  X(PFNGLDELETESYNCPROC, DeleteSync)                                     \
  X(PFNGLDELETETEXTURESPROC, DeleteTextures)                             \
  X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)                     \
  X(PFNGLDEPTHFUNCPROC, DepthFunc)                                       \
  X(PFNGLDISABLEPROC, Disable)                                           \
  X(PFNGLDISPATCHCOMPUTEPROC, DispatchCompute)                           \
  X(PFNGLDISPATCHCOMPUTEINDIRECTPROC, DispatchComputeIndirect)           \
  X(PFNGLDRAWARRAYSPROC, DrawArrays)                                     \
  X(PFNGLDRAWELEMENTSINSTANCEDPROC, DrawElementsInstanced)               \
  X(PFNGLENABLEPROC, Enable)                                             \
  X(PFNGLENABLEVERTEXARRAYATTRIBPROC, EnableVertexArrayAttrib)           \
  X(PFNGLENDQUERYPROC, EndQuery)                                         \
  X(PFNGLENDTRANSFORMFEEDBACKPROC, EndTransformFeedback)                 \
  X(PFNGLFENCESYNCPROC, FenceSync)                                       \
  X(PFNGLFINISHPROC, Finish)                                             \
  X(PFNGLGETERRORPROC, GetError)                                         \
  X(PFNGLGETINTEGER64VPROC, GetInteger64v)                               \
  X(PFNGLGETINTEGERVPROC, GetIntegerv)                                   \
  X(PFNGLGETNAMEDBUFFERSUBDATAPROC, GetNamedBufferSubData)               \
  X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)                       \
  X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                                 \
  X(PFNGLGETQUERYOBJECTUI64VPROC, GetQueryObjectui64v)                   \
  X(PFNGLGETQUERYIVPROC, GetQueryiv)                                     \
  X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)                         \
  X(PFNGLGETSHADERIVPROC, GetShaderiv)                                   \
  X(PFNGLGETSTRINGPROC, GetString)                                       \
  X(PFNGLLINKPROGRAMPROC, LinkProgram)                                   \
  X(PFNGLMAPNAMEDBUFFERRANGEPROC, MapNamedBufferRange)                   \
  X(PFNGLMEMORYBARRIERPROC, MemoryBarrier)                               \
  X(PFNGLNAMEDBUFFERDATAPROC, NamedBufferData)                           \
  X(PFNGLNAMEDBUFFERSTORAGEPROC, NamedBufferStorage)                     \
  X(PFNGLNAMEDBUFFERSUBDATAPROC, NamedBufferSubData)                     \
  X(PFNGLNAMEDFRAMEBUFFERDRAWBUFFERSPROC, NamedFramebufferDrawBuffers)   \
  X(PFNGLNAMEDFRAMEBUFFERREADBUFFERPROC, NamedFramebufferReadBuffer)     \
  X(PFNGLNAMEDFRAMEBUFFERRENDERBUFFERPROC, NamedFramebufferRenderbuffer) \
  X(PFNGLNAMEDFRAMEBUFFERTEXTUREPROC, NamedFramebufferTexture)           \
  X(PFNGLNAMEDRENDERBUFFERSTORAGEPROC, NamedRenderbufferStorage)         \
  X(PFNGLPIXELSTOREIPROC, PixelStorei)                                   \
  X(PFNGLPROGRAMUNIFORM1FPROC, ProgramUniform1f)                         \
  X(PFNGLPROGRAMUNIFORM1IPROC, ProgramUniform1i)                         \
  X(PFNGLPROGRAMUNIFORM1UIPROC, ProgramUniform1ui)                       \
  X(PFNGLPROGRAMUNIFORMMATRIX4FVPROC, ProgramUniformMatrix4fv)           \
  X(PFNGLREADPIXELSPROC, ReadPixels)                                     \
  X(PFNGLSHADERSOURCEPROC, ShaderSource)                                 \
  X(PFNGLTEXTUREBUFFERPROC, TextureBuffer)                               \
  X(PFNGLTEXTUREPARAMETERIPROC, TextureParameteri)                       \
  X(PFNGLTEXTURESTORAGE2DPROC, TextureStorage2D)                         \
  X(PFNGLTEXTURESUBIMAGE2DPROC, TextureSubImage2D)                       \
  X(PFNGLTRANSFORMFEEDBACKVARYINGSPROC, TransformFeedbackVaryings)       \
  X(PFNGLUSEPROGRAMPROC, UseProgram)                                     \
  X(PFNGLVERTEXARRAYATTRIBBINDINGPROC, VertexArrayAttribBinding)         \
  X(PFNGLVERTEXARRAYATTRIBFORMATPROC, VertexArrayAttribFormat)           \
  X(PFNGLVERTEXARRAYATTRIBIFORMATPROC, VertexArrayAttribIFormat)         \
  X(PFNGLVERTEXARRAYELEMENTBUFFERPROC, VertexArrayElementBuffer)         \
  X(PFNGLVERTEXARRAYVERTEXBUFFERPROC, VertexArrayVertexBuffer)           \
  X(PFNGLVIEWPORTPROC, Viewport)

/// The loaded functions, named without their "gl".
struct GlFunctions {
#define VESTIGE_GL_MEMBER(type, name) type name = nullptr;
  VESTIGE_GL_FUNCTIONS(VESTIGE_GL_MEMBER)
#undef VESTIGE_GL_MEMBER
};

}  // namespace vestige
