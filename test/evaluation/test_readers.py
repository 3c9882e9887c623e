# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest

from het_ros.evaluation.annotations import read_boxes
from het_ros.evaluation.readers import read_sequences

NAN = [np.nan] * 4


@pytest.mark.parametrize(
    ("text", "first_pixel", "boxes"),
    [
        ("10,20,30,40\n", 1, [[9, 19, 30, 40]]),  # commas; OTB counts from 1
        ("10\t20\t30\t40\n", 1, [[9, 19, 30, 40]]),  # tabs
        ("10 20  30 40\n", 1, [[9, 19, 30, 40]]),  # blanks
        ("10, 20,\t30 , 40", 1, [[9, 19, 30, 40]]),  # everything at once, no line end
        ("1,2,3,4\r\n5,6,7,8\r\n", 1, [[0, 1, 3, 4], [4, 5, 7, 8]]),  # CR line ends
        ("1,2,3,4\r5,6,7,8\r", 1, [[0, 1, 3, 4], [4, 5, 7, 8]]),  # CR alone
        ("\ufeff1,2,3,4\n\n\n", 1, [[0, 1, 3, 4]]),  # byte order mark, empty lines at the end
        ("10.5,20.25,3,4", 0, [[10.5, 20.25, 3, 4]]),  # VOT counts from 0
        ("1,2,3,4\nNaN,NaN,NaN,NaN\n1,2,3,4", 0, [[1, 2, 3, 4], NAN, [1, 2, 3, 4]]),  # UAV123
        ("0,0,0,0", 1, [NAN]),  # no area: absent
        ("5,5,10,-1", 1, [NAN]),
        ("1,1,11,1,11,21,1,21", 0, [[1, 1, 10, 20]]),  # polygon: its bounds
        ("6,1,11,6,6,11,1,6", 0, [[1, 1, 10, 10]]),  # rotated by 45 degrees
        ("nan,nan,nan,nan,nan,nan,nan,nan", 0, [NAN]),
        ("m3,4,5,6,7,1,9", 0, [[3, 4, 5, 6]]),  # mask: its bounds
    ],
)
def test_lines_of_ground_truth(tmp_path, text, first_pixel, boxes):
    file = tmp_path / "truth.txt"
    file.write_bytes(text.encode())
    np.testing.assert_array_equal(read_boxes(file, first_pixel), np.array(boxes, float))


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("1,2,3,4\n1,2,3\n", r"line 2: 4 numbers, or a polygon's corners"),
        ("1,2,3,4\n\n1,2,3,4\n", r"line 2"),  # a hole would shift all later boxes
        ("a,b,c,d\n", r"line 1"),
        ("", "is empty"),
    ],
)
def test_a_broken_line_is_named(tmp_path, text, complaint):
    file = tmp_path / "truth.txt"
    file.write_text(text)
    with pytest.raises(ValueError, match=complaint):
        read_boxes(file, 1)


def folder(root, name, numbers, truths, images="img", digits=4):
    place = root / name / images
    place.mkdir(parents=True)
    for number in numbers:
        shade = np.full((8, 8, 3), number % 256, np.uint8)
        cv2.imwrite(str(place / f"{number:0{digits}d}.png"), shade)
    for file, text in truths.items():
        (root / name / file).write_text(text)


def boxes(n):
    return "".join(f"{k},1,4,4\n" for k in range(1, n + 1))


def test_otb_folder_reads_images_boxes_and_attributes(tmp_path):
    folder(tmp_path, "A", range(1, 4), {"groundtruth_rect.txt": boxes(3)})
    (tmp_path / "attributes.json").write_text('{"A": ["OCC"]}')
    (sequence,) = read_sequences(tmp_path)
    assert (sequence.name, sequence.attributes, len(sequence.frames)) == ("A", ("OCC",), 3)
    assert sequence.truth[0].tolist() == [0, 0, 4, 4]
    assert sequence.frames[2].shape == (8, 8, 3)
    assert sequence.frames[2][0, 0, 0] == 3
    assert sequence.frames.dt == pytest.approx(1 / 30)


def test_several_targets_become_several_sequences(tmp_path):
    truths = {f"groundtruth_rect.{k}.txt": boxes(2) for k in (1, 2, 10)}
    folder(tmp_path, "Skating2", (1, 2), truths)
    names = [sequence.name for sequence in read_sequences(tmp_path)]
    assert names == ["Skating2-1", "Skating2-2", "Skating2-3"]


@pytest.mark.parametrize(
    ("name", "numbers", "lines", "first", "frames", "first_line"),
    [
        ("David", range(1, 771), 471, 300, 471, 0),  # annotated from image 300 on
        ("David", range(300, 771), 471, 300, 471, 0),  # only the annotated images there
        ("Football1", range(1, 80), 74, 1, 74, 0),  # annotated up to image 74
        ("Tiger1", range(6, 355), 354, 6, 349, 5),  # boxes for images that do not count
        ("Other", range(100, 110), 10, 100, 10, 0),  # whatever the number, they belong together
    ],
)
def test_first_frame_that_is_not_1(tmp_path, name, numbers, lines, first, frames, first_line):
    folder(tmp_path, name, [], {"groundtruth_rect.txt": boxes(lines)})
    for number in numbers:
        (tmp_path / name / "img" / f"{number:04d}.jpg").touch()
    (sequence,) = read_sequences(tmp_path)
    assert sequence.frames.files[0].endswith(f"{first:04d}.jpg")
    assert len(sequence.frames) == frames
    assert sequence.truth[0, 0] == first_line


def test_more_images_than_boxes_warns_and_keeps_the_first(tmp_path):
    folder(tmp_path, "A", range(1, 6), {"groundtruth_rect.txt": boxes(3)})
    with pytest.warns(UserWarning, match="A: 5 images, but 3 boxes; the first 3 are used"):
        (sequence,) = read_sequences(tmp_path)
    assert len(sequence.frames) == 3


def test_a_target_that_is_absent_at_first_starts_where_it_appears(tmp_path):
    text = "NaN,NaN,NaN,NaN\n5,5,4,4\nNaN,NaN,NaN,NaN\n"
    folder(tmp_path, "A", (1, 2, 3), {"groundtruth_rect.txt": text})
    (sequence,) = read_sequences(tmp_path)
    assert sequence.visible.tolist() == [True, False]
    assert sequence.frames.files[0].endswith("0002.png")


def test_vot_folder(tmp_path):
    truth = "1,1,5,1,5,5,1,5\n2,2,4,4\n"
    truths = {"groundtruth.txt": truth, "sequence": "name=a\nfps=25\n"}
    folder(tmp_path, "a", (1, 2), truths, images="color", digits=8)
    (sequence,) = read_sequences(tmp_path)
    assert sequence.truth.tolist() == [[1, 1, 4, 4], [2, 2, 4, 4]], "VOT counts from 0"
    assert sequence.frames.rate == 25


def test_absence_labels_make_frames_invalid(tmp_path):
    truths = {"groundtruth.txt": boxes(3), "absence.label": "0\n1\n0\n"}
    folder(tmp_path, "a", (1, 2, 3), truths, images=".")
    assert read_sequences(tmp_path)[0].visible.tolist() == [True, False, True]


def test_one_sequence_by_its_own_folder_and_frame_rates(tmp_path):
    folder(tmp_path, "A", (1, 2), {"groundtruth_rect.txt": boxes(2)})
    (sequence,) = read_sequences(tmp_path / "A", rates={"": 30, "A": 10})
    assert (sequence.name, sequence.frames.rate) == ("A", 10)


def test_what_is_missing_is_named(tmp_path):
    with pytest.raises(ValueError, match="is not a folder"):
        read_sequences(tmp_path / "nowhere")
    with pytest.raises(ValueError, match="holds no sequence"):
        read_sequences(tmp_path)
    folder(tmp_path, "A", (1, 2), {"groundtruth_rect.txt": boxes(2)})
    with pytest.raises(ValueError, match="has no B; it has A"):
        read_sequences(tmp_path, ("B",))
    folder(tmp_path, "C", (), {"groundtruth_rect.txt": boxes(2)})
    with pytest.raises(ValueError, match="holds no images"):
        read_sequences(tmp_path)


def test_an_image_that_cannot_be_read_is_named(tmp_path):
    folder(tmp_path, "A", (1, 2), {"groundtruth_rect.txt": boxes(2)})
    (tmp_path / "A" / "img" / "0002.png").write_text("no image")
    (sequence,) = read_sequences(tmp_path)
    with pytest.raises(OSError, match=r"0002\.png cannot be read"):
        sequence.frames[1]


def test_the_sequences_here_are_whole(data):
    sequences = {sequence.name: sequence for sequence in read_sequences(data)}
    folders = [folder for folder in data.iterdir() if list(folder.glob("groundtruth*.txt"))]
    names = set(sequences) | {name.rpartition("-")[0] for name in sequences}  # several targets
    assert {folder.name for folder in folders} <= names
    if "David" in sequences:
        assert sequences["David"].frames.files[0].endswith("0300.jpg")
    if "FaceOcc1" in sequences:
        assert sequences["FaceOcc1"].truth[0].tolist() == [117, 68, 114, 162]  # tabs, CR
    for sequence in sequences.values():
        height, width = sequence.frames[0].shape[:2]
        x, y, w, h = sequence.truth[0]
        assert 0 <= x < x + w <= width, sequence.name
        assert 0 <= y < y + h <= height, sequence.name
