// The scene of a viewer: read from its file again and again, with what the viewer changes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

#include "field_cache.h"
#include "options.h"
#include "pbrt_translation.h"
#include "scene_edits.h"

namespace vkvol {

class WatchedScene {
public:
    // Throws InputError.
    explicit WatchedScene(const ViewOptions& options);

    // Whether the file has changed since it was read; it is read again then. Throws InputError if it cannot be: what
    // was read before stays.
    bool refresh();

    struct Read {
        std::string xml; // with the edits
        Scene scene;
    };
    // As it is rendered, with warnings of what of it is not. `layers`: of the picture, besides the request's. Throws
    // InputError.
    Read read(const SceneEdits& edits, const std::string& layers, FieldCache& fields) const;

    const std::string& name() const { return name_; }
    bool has_grids() const { return !grids_.empty(); } // that stand in the scene, and in no file

private:
    void load();

    const ViewOptions& options_;
    std::string name_;
    std::filesystem::path file_; // names in the text are beside it
    std::string xml_;
    NamedGrids grids_;               // of a scene that was translated
    std::vector<std::string> notes_; // of what of it was not
    bool has_view_ = false;
    std::pair<std::filesystem::file_time_type, std::uintmax_t> state_{};
};

} // namespace vkvol
