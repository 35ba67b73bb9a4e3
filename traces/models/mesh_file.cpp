#include "traces/models/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <system_error>

#include "model/error.h"
#include "model/processes.h"
#include "model/run_apart.h"
#include "traces/models/assimp_files.h"
#include "traces/models/gltf_check.h"
#include "traces/models/obj_text.h"
#include "traces/models/off_check.h"
#include "traces/models/ply_text.h"
#include "traces/models/texture_image.h"
#include "traces/point_file.h"

namespace splatscope::traces {
namespace {

// What colours the parts of a mesh file. Some may have colours or places in a texture, and others none.
struct Materials {
  struct Material {
    glm::vec3 color{0.85f};
    std::shared_ptr<const TextureImage> texture;  // several may share one; null: none
  };
  struct Part {
    std::size_t material = 0;
    bool texcoords = false, colors = false;
  };
  std::vector<Material> materials;
  std::vector<Part> parts;

  glm::vec3 operator()(const SurfacePoint& point) const {
    const Part& part = parts[point.part];
    const Material& material = materials[part.material];
    if (material.texture && part.texcoords) return material.texture->at(point.texcoord);
    return part.colors ? point.color : material.color;
  }
};

std::optional<TextureImage> read_texture_of(const aiScene& scene, const aiString& name,
                                            const std::filesystem::path& folder) {
  const aiTexture* embedded = scene.GetEmbeddedTexture(name.C_Str());
  if (!embedded) return read_texture(file_named(name.C_Str(), folder));
  if (embedded->mHeight == 0)
    return read_texture(
        std::as_bytes(std::span(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth)),
        embedded->achFormatHint);
  TextureImage image{embedded->mWidth, embedded->mHeight, {}};
  for (std::size_t i = 0; i < image.width * image.height; ++i) {
    const aiTexel& texel = embedded->pcData[i];
    image.texels.insert(image.texels.end(), {texel.r, texel.g, texel.b});
  }
  if (image.texels.empty()) return std::nullopt;
  return image;
}

enum class Textures : std::uint8_t { read, left_out };

class Reader {
 public:
  Reader(const std::filesystem::path& path, aiScene& scene, Textures textures)
      : path_(path), scene_(scene), textures_(textures) {}

  MeshFile read() {
    read_materials();
    add(*scene_.mRootNode, aiMatrix4x4());
    Mesh& mesh = file_.model.mesh;
    if (mesh.triangles.empty()) throw UserError(path_.string(), 0, "holds no triangles, expected a mesh");
    if (!any_normals_) mesh.normals.clear();
    if (!any_texcoords_) mesh.texcoords.clear();
    if (!any_colors_) mesh.colors.clear();
    file_.model.paint = [materials = materials_](const SurfacePoint& point) { return (*materials)(point); };
    return std::move(file_);
  }

 private:
  void read_materials() {
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
      Materials::Material material;
      unsigned texcoord_set = 0;
      aiString name;
      aiColor3D color;
      scene_.mMaterials[i]->Get(AI_MATKEY_NAME, name);
      const bool made_up = std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME;
      if (!made_up && scene_.mMaterials[i]->Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS)
        material.color = {color.r, color.g, color.b};
      for (aiTextureType type : {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR}) {
        aiString texture;
        if (scene_.mMaterials[i]->GetTexture(type, 0, &texture, nullptr, &texcoord_set) != aiReturn_SUCCESS)
          continue;
        material.texture = texture_of(texture);
        if (!material.texture) ++file_.textures_unreadable;
        break;
      }
      note_texture_files(*scene_.mMaterials[i]);
      materials_->materials.push_back(std::move(material));
      texcoord_sets_.push_back(texcoord_set);
    }
    if (!materials_->materials.empty()) return;
    materials_->materials.emplace_back();
    texcoord_sets_.push_back(0);
  }

  // Each is read once, however many materials name it.
  std::shared_ptr<const TextureImage> texture_of(const aiString& name) {
    const auto [found, is_new] = texture_by_name_.try_emplace(name.C_Str());
    if (is_new && textures_ == Textures::read) {
      if (auto image = read_texture_of(scene_, name, path_.parent_path()))
        found->second = std::make_shared<const TextureImage>(std::move(*image));
    }
    return found->second;
  }

  // Those of all kinds, bump maps and the like, not only those that colour the surfels.
  void note_texture_files(const aiMaterial& material) {
    for (unsigned i = 0; i < material.mNumProperties; ++i) {
      const aiMaterialProperty& property = *material.mProperties[i];
      aiString name;
      if (std::string_view(property.mKey.C_Str()) != _AI_MATKEY_TEXTURE_BASE) continue;
      if (material.Get(_AI_MATKEY_TEXTURE_BASE, property.mSemantic, property.mIndex, name) !=
          aiReturn_SUCCESS)
        continue;
      if (!scene_.GetEmbeddedTexture(name.C_Str()))
        file_.files.push_back(file_named(name.C_Str(), path_.parent_path()));
    }
  }

  void add(const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 transform = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene_.mMeshes[node.mMeshes[i]], transform);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], transform);
  }

  void add(const aiMesh& from, const aiMatrix4x4& transform) {
    Mesh& mesh = file_.model.mesh;
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    // A node may show a mesh again and again.
    if (mesh.triangles.size() + from.mNumFaces > kMostTriangles ||
        mesh.positions.size() + from.mNumVertices > 3 * kMostTriangles)
      throw UserError(path_.string(), 0,
                      fmt::format("has more than {} triangles, or three vertices for each, expected fewer",
                                  kMostTriangles));
    const aiMatrix3x3 turn = aiMatrix3x3(transform).Inverse().Transpose();
    const std::size_t material = std::min<std::size_t>(from.mMaterialIndex, texcoord_sets_.size() - 1);
    const unsigned set = texcoord_sets_[material];
    const bool texcoords = from.HasTextureCoords(set), colors = from.HasVertexColors(0);
    any_normals_ |= from.HasNormals();
    any_texcoords_ |= texcoords;
    any_colors_ |= colors;
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
      const aiVector3D p = transform * from.mVertices[i];
      const aiVector3D n = from.HasNormals() ? turn * from.mNormals[i] : aiVector3D();
      mesh.positions.emplace_back(p.x, p.y, p.z);
      mesh.normals.emplace_back(n.x, n.y, n.z);
      mesh.texcoords.push_back(
          texcoords ? glm::vec2(from.mTextureCoords[set][i].x, from.mTextureCoords[set][i].y) : glm::vec2());
      mesh.colors.push_back(colors
                                ? glm::vec3(from.mColors[0][i].r, from.mColors[0][i].g, from.mColors[0][i].b)
                                : glm::vec3(0.85f));
    }
    const auto part = static_cast<std::uint32_t>(materials_->parts.size());
    materials_->parts.push_back({material, texcoords, colors});
    const bool mirrored = aiMatrix3x3(transform).Determinant() < 0;  // front faces stay front faces
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
      const aiFace& face = from.mFaces[i];
      if (face.mNumIndices != 3) continue;  // points and lines have no surface
      mesh.triangles.push_back({face.mIndices[0] + base, face.mIndices[mirrored ? 2 : 1] + base,
                                face.mIndices[mirrored ? 1 : 2] + base});
      mesh.parts.push_back(part);
    }
  }

  const std::filesystem::path& path_;
  const aiScene& scene_;
  const Textures textures_;
  MeshFile file_;
  std::map<std::string, std::shared_ptr<const TextureImage>> texture_by_name_;
  std::vector<unsigned> texcoord_sets_;  // of a material, that its texture is laid out by
  std::shared_ptr<Materials> materials_ = std::make_shared<Materials>();
  bool any_normals_ = false, any_texcoords_ = false, any_colors_ = false;
};

// Faces with an index beyond the vertices become faces of nothing. Returns how many; tells of larger
// polygons.
std::size_t drop_faces_out_of_range(aiScene& scene, bool& polygons) {
  std::size_t dropped = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      aiFace& face = mesh.mFaces[i];
      const bool beyond = std::any_of(face.mIndices, face.mIndices + face.mNumIndices,
                                      [&](unsigned index) { return index >= mesh.mNumVertices; });
      if (beyond) {
        face.mNumIndices = 1;
        face.mIndices[0] = 0;
        ++dropped;
      }
      polygons |= face.mNumIndices > 3;
    }
  }
  return dropped;
}

// Material files that an OBJ file names and that are not there. After each assimp looks for one of the mesh's
// own name, which is none that was missed.
std::size_t missing_materials(const std::vector<std::filesystem::path>& files, std::filesystem::path mesh) {
  std::set<std::filesystem::path> missing;
  for (const std::filesystem::path& file : files) {
    std::error_code error;
    if (ending_of(file) == ".mtl" && !std::filesystem::is_regular_file(file, error))
      missing.insert(file.lexically_normal());
  }
  if (missing.size() > 1) missing.erase(mesh.replace_extension(".mtl").lexically_normal());
  return missing.size();
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& path) {
  return ending_of(path) != ".ply" || ply_has_faces(path);
}

namespace {

MeshFile read_whole(const std::filesystem::path& path, Textures textures) {
  const std::string file = path.string();
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(path, error);
  if (!regular || !std::ifstream(path)) throw UserError(file, 0, "cannot be read, expected a mesh");
  if (ending_of(path) == ".off") expect_whole_off(path);
  if (ending_of(path) == ".gltf" || ending_of(path) == ".glb") expect_plain_gltf(path);
  if (ending_of(path) == ".ply" && !ply_has_faces(path))
    throw UserError(file, 0, "holds no faces, expected a mesh");
  std::string text;
  if (ending_of(path) == ".obj") text = obj_text(path);
  if (ending_of(path) == ".ply") text = ply_text(path);
  std::vector<std::filesystem::path> files;
  Assimp::Importer importer;
  importer.SetIOHandler(new AssimpFiles(files, path, std::move(text)));  // the importer's to delete
  if (!importer.IsExtensionSupported(ending_of(path)))
    throw UserError(file, 0,
                    "has no ending that assimp knows, expected a mesh such as .ply, .obj, .off or .stl");
  if (!importer.ReadFile(file, 0))
    throw UserError(file, 0,
                    fmt::format("assimp says \"{}\", expected a whole mesh", importer.GetErrorString()));
  // Post-processing trusts the indices: they are checked between the two steps.
  bool polygons = false;
  auto* scene =
      const_cast<aiScene*>(importer.GetScene());  // the importer keeps it, unchanged but for the faces
  if (!scene->mRootNode) throw UserError(file, 0, "holds no triangles, expected a mesh");
  const std::size_t dropped = drop_faces_out_of_range(*scene, polygons);
  if (polygons && !importer.ApplyPostProcessing(aiProcess_Triangulate))
    throw UserError(file, 0, "its polygons cannot be cut into triangles, expected a mesh");
  MeshFile result = Reader(path, *scene, textures).read();
  result.faces_out_of_range = dropped;
  result.materials_unreadable = missing_materials(files, path);
  result.files.insert(result.files.end(), files.begin(), files.end());
  return result;
}

constexpr std::uint64_t kMebibyte = 1 << 20;

template <auto resource>
void limit(std::uint64_t most) {
  const rlimit value{most, most};
  ::setrlimit(resource, &value);
}

// Address space of this process, bytes.
std::uint64_t address_space() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

// Formats whose parts nest are read by functions that call themselves, and a part may stand for copies of
// copies: a small file can overflow the stack, which nothing catches, or fill all memory. So these are read
// in a process of its own first, with less stack than a thread of this one has (2 MiB where the shell sets no
// limit), and memory for large files beside it.
void expect_bounded(const std::filesystem::path& path) {
  constexpr std::string_view kFlat[] = {".obj", ".off", ".ply", ".stl"};
  if (std::ranges::find(kFlat, ending_of(path)) != std::end(kFlat)) return;
  const auto try_it = [&](std::size_t) {
    limit<RLIMIT_CORE>(0);
    limit<RLIMIT_STACK>(kMebibyte);
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(path, error);
    if (!error) limit<RLIMIT_AS>(address_space() + 8192 * kMebibyte + 64 * size);
    read_whole(path, Textures::left_out);
    return std::string();
  };
  try {
    in_processes(1, 1, try_it);
  } catch (const UserError&) {
    throw;
  } catch (const std::system_error&) {
    throw;  // no process or pipe could be had, which says nothing of the mesh
  } catch (const std::runtime_error&) {
    throw UserError(
        path.string(), 0,
        "its reader breaks down, or takes 8 GiB and 64 times the size of the file, expected a mesh whose "
        "parts nest less deeply, and repeat less often");
  }
}

}  // namespace

MeshFile read_mesh(const std::filesystem::path& path) {
  expect_bounded(path);
  return run_apart([path] { return read_whole(path, Textures::read); });  // assimp cannot be interrupted
}

}  // namespace splatscope::traces
