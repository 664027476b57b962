"""Laws of the layout of diagrams."""

from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.pictures.pages.layout import Box, layout

SIZES = st.tuples(st.floats(20, 200), st.floats(15, 120))


@st.composite
def graphs(draw):
    sizes = draw(st.lists(SIZES, min_size=1, max_size=14))
    boxes = [Box(f"b{i}", *size) for i, size in enumerate(sizes)]
    name = st.integers(0, len(boxes) - 1).map(lambda i: f"b{i}")
    return boxes, draw(st.lists(st.tuples(name, name), max_size=25))


@given(graphs())
def test_boxes_never_overlap(graph):
    boxes, edges = graph
    corners = layout(boxes, edges).corners
    for i, a in enumerate(boxes):
        for b in boxes[i + 1 :]:
            (x, y), (u, v) = corners[a.name], corners[b.name]
            apart = x + a.width <= u or u + b.width <= x
            assert apart or y + a.height <= v + 1e-6 or v + b.height <= y + 1e-6


@given(graphs())
def test_everything_lies_inside_the_drawing(graph):
    boxes, edges = graph
    placed = layout(boxes, edges)
    for box in boxes:
        x, y = placed.corners[box.name]
        assert -1e-6 <= x <= placed.width - box.width + 1e-6
        assert -1e-6 <= y <= placed.height - box.height + 1e-6


@given(graphs())
def test_edges_lead_to_the_right_where_there_is_no_circle(graph):
    boxes, edges = graph
    forward = [(a, b) for a, b in edges if int(a[1:]) < int(b[1:])]
    corners = layout(boxes, forward).corners
    assert all(corners[a][0] < corners[b][0] for a, b in forward)


@given(graphs())
def test_the_same_graph_gets_the_same_layout(graph):
    assert layout(*graph) == layout(*graph)
