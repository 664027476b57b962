"""Best tours of several robots, found by trying all."""

from itertools import pairwise, permutations, product


def longest_of_best(between, there, back, work):
    """Return the longest tour of the best tours, each at least with its works."""
    robots, places = there.shape
    tour = {}
    for robot in range(robots):
        for k in range(1 << places):
            some = [i for i in range(places) if k >> i & 1]
            whole = (
                there[robot, order[0]]
                + sum(between[pair] for pair in pairwise(order))
                + back * there[robot, order[-1]]
                for order in permutations(some)
                if order
            )
            tour[robot, k] = min(whole, default=0.0) + work * len(some)
    chosen = product(range(robots), repeat=places)
    masks = (
        [sum(1 << i for i, r in enumerate(each) if r == robot) for robot in range(robots)] for each in chosen
    )
    return min(max(tour[robot, k] for robot, k in enumerate(each)) for each in masks)
