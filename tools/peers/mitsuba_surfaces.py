"""vkvol's surfaces in Mitsuba's terms: entries of a dictionary for load_dict."""
from mitsuba_lights import rgb


def bsdf(surface):
    kind = surface.material
    if kind in ("dielectric", "thinDielectric"):
        return {"type": kind.lower(), "int_ior": surface.ior, "ext_ior": 1.0, "specular_reflectance": rgb(surface.color),
                "specular_transmittance": rgb(surface.color)}
    if kind == "coated":
        one_sided = {"type": "plastic", "diffuse_reflectance": rgb(surface.color), "int_ior": surface.ior, "ext_ior": 1.0,
                     "nonlinear": True}
    elif kind == "diffuse":
        one_sided = {"type": "diffuse", "reflectance": rgb(surface.color)}
    elif kind == "mirror":
        one_sided = {"type": "conductor", "material": "none", "specular_reflectance": rgb(surface.color)}
    else:
        one_sided = {"type": "conductor", "eta": rgb(surface.eta), "k": rgb(surface.k), "specular_reflectance": rgb(surface.color)}
    return {"type": "twosided", "bsdf": one_sided}


def entry(mi, surface):
    shape = {"type": surface.shape}
    if surface.shape == "mesh":
        shape = {"type": "obj", "filename": str(surface.file), "face_normals": True}
    shape.update(to_world=mi.ScalarTransform4f(surface.matrix.tolist()), bsdf=bsdf(surface))
    if surface.emission.any():
        shape["emitter"] = {"type": "area", "radiance": rgb(surface.emission)}
    return shape
