"""The same frames under the names and signs of other programs, and their motion as files of the flow benchmarks."""

import struct

import OpenImageIO as oiio

import sequences
from checks import *
from evaluation import flow_files, frames

MOVING = dict(shift=(3, -2), turn=0.01, extent="border", width=110, height=96)


CYCLES_LACKS = {"velocity.X", "velocity.Y", "velocity.Z", "texture.age", "texture.distortion", "texture.id"}


def same(got, expected, without=()):
    """@param without  beginnings of the names of figures that these frames cannot have"""
    for name, value in expected.items():
        if name.startswith(without):
            assert got.get(name) is None, f"{name}: got {got[name]}, which the frames do not say"
        elif value is None:
            assert got[name] is None, f"{name}: got {got[name]}, expected none"
        else:
            near(got, name, value, 1e-4)


def test_layouts_give_the_same_figures(folder):
    scene, exemplar = scene_of(folder, crop=108, **MOVING)
    found = {}
    for layout in ("ebru", "nuke", "blender"):
        paths = write(folder / layout, scene, layout=layout)
        found[layout] = evaluate(paths, exemplar, side=21, windows=15, layout=layout)["summary"]
    planes = {layout: frames.read(folder / layout / "plane.0001.exr", 1, layout).planes for layout in found}
    assert planes["nuke"].keys() == planes["ebru"].keys()
    assert planes["ebru"].keys() - planes["blender"].keys() == CYCLES_LACKS, planes["blender"].keys()
    for layout in ("nuke", "blender"):
        for name, values in planes[layout].items():
            # Cycles' V goes up the image, t goes down; only its differences count.
            if (layout, name) != ("blender", "texture.t"):
                assert np.abs(values - planes["ebru"][name]).max() < 1e-6, f"{layout}: {name}"
    for name in ("energy_ratio", "contrast", "flow_epe", "warp_error", "distortion_mean", "motion_check_p99", "holes"):
        assert found["ebru"][name] is not None, f"{name}: nothing to compare"
    same(found["nuke"], found["ebru"])
    # Cycles writes no velocity.
    same(found["blender"], found["ebru"], without=("motion_check", "motion_second"))


def test_blender_without_ebrus_header(folder):
    """As Blender writes it: no camera, no texel size. Flow and contrast can be had, and the reasons name the rest."""
    scene, exemplar = scene_of(folder, **MOVING)
    paths = write(folder / "frames", scene, layout="blender", header=False)
    result = evaluate(paths, exemplar, side=21, layout="blender", texel_size_world=scene.texel_size)
    below(result["summary"], "flow_excess", 0.1)
    above(result["summary"], "contrast", 0.8)
    near(result["summary"], "distortion_mean", 1, 1e-3)
    missing_because(result, ids("energy", "cover", "spectrum"), "worldToNDC")
    missing_because(result, ids("motion_check"), "velocity.X")


def test_layout_that_is_another(folder):
    scene, _ = scene_of(folder, **MOVING)
    (path, _) = write(folder / "frames", scene, layout="blender").values()
    refused(lambda: frames.read(path, 1, "ebru"), "plane.0001.exr", "ViewLayer.", "--layout")


def test_lit_picture_instead_of_albedo(folder):
    """R G B is 0.8 of albedo here: another contrast, by the sRGB curve; nothing else moves."""
    scene, exemplar = scene_of(folder, **MOVING)
    paths = write(folder / "frames", scene)
    albedo, lit = (evaluate(paths, exemplar, colour=colour)["summary"] for colour in ("albedo", "rgb"))
    # The curve is about a power of 1 / 2.4.
    near(lit, "contrast", albedo["contrast"] * 0.8 ** (1 / 2.4), 0.03)
    near(lit, "flow_excess", albedo["flow_excess"], 0.05)


def test_data_window_smaller_than_the_picture(folder):
    """Nuke and Blender crop a file to what is in it; the camera still means the whole picture. Rows and columns cut
    off the border without fluid change nothing."""
    scene, exemplar = scene_of(folder, crop=108, **MOVING)
    whole = write(folder / "whole", scene)
    cropped = {}
    (folder / "cropped").mkdir()
    for number, path in whole.items():
        picture = oiio.ImageBuf(str(path))
        inner = oiio.ROI(7, scene.width - 3, 5, scene.height - 4, 0, 1, 0, picture.nchannels)
        part = oiio.ImageBufAlgo.crop(picture, inner)
        part.set_full(0, scene.width, 0, scene.height, 0, 1)
        cropped[number] = folder / "cropped" / path.name
        assert part.write(str(cropped[number])), part.geterror()
    # Judged as one sequence, with a gap between them.
    result = evaluate(whole | {number + 3: path for number, path in cropped.items()}, exemplar, side=21)
    for name, tolerance in (("energy_ratio", 0.15), ("motion_check_p99", 1e-4), ("contrast", 1e-6),
                            ("warp_error", 1e-3), ("distortion_mean", 1e-4)):
        near(row(result, 4), name, row(result, 1)[name], tolerance)


def read_flo(path):
    """@return H x W x 2: u right, v down"""
    data = path.read_bytes()
    assert data[:4] == b"PIEH", data[:4]
    width, height = struct.unpack_from("<ii", data, 4)
    assert len(data) == 12 + 8 * width * height, len(data)
    return np.frombuffer(data, "<f4", offset=12).reshape(height, width, 2)


def read_kitti(path):
    """@return H x W x 2: u right, v down, and H x W: valid"""
    picture = oiio.ImageBuf(str(path))
    assert picture.spec().format.basetype == oiio.UINT16
    values = picture.get_pixels(oiio.UINT16).astype(float)
    return (values[..., :2] - 32768) / 64, values[..., 2]


def test_flow_files(folder):
    """forward of the frame, v turned to rows; none where there is no fluid and where it is no number."""
    scene, _ = scene_of(folder, **MOVING)

    def spoil(planes, frame):
        planes["forward.v"][50, 40] = np.nan

    (path, _) = write(folder / "frames", scene, change=spoil).values()
    planes, valid = sequences.planes(scene, 1), sequences.fluid(scene)
    expected = np.dstack([planes["forward.u"], -planes["forward.v"]])
    valid[50, 40] = False
    frame = frames.read(path, 1)

    got = read_flo(flow_files.write(folder, "plane", frame, "flo"))
    assert got.shape == expected.shape, got.shape
    assert (got[valid] == expected[valid]).all()
    assert (got[~valid] > 1e9).all(), "Middlebury: unknown is over 1e9"

    got, known = read_kitti(flow_files.write(folder, "plane", frame, "kitti"))
    assert (known == valid).all()
    assert np.abs(got - expected)[valid].max() <= 1 / 128 + 1e-4


if __name__ == "__main__":
    main()
