"""Zenoh configurations for the bus: each process shows a certificate, and speaks only for its robots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mmrs_runtime.bus.messages import digest


@dataclass(frozen=True, slots=True)
class Holder:
    """Who gets a certificate, and the robots for which it may speak: those of one process."""

    name: str
    robots: tuple[str, ...]


def configuration(own: Holder, holders: Sequence[Holder]) -> Mapping[str, object]:
    """Return Zenoh's configuration of a holder, one of all; it stands beside the holder's keys.

    Peers show each other their certificates; what comes in is let through only where it speaks for a
    robot of the certificate's holder.
    """
    return {
        "metadata": {"name": own.name, "robots": list(own.robots)},
        "mode": "peer",
        "listen": {"endpoints": ["tls/0.0.0.0:0"]},
        "scouting": {"multicast": {"enabled": False}},
        "transport": {
            "link": {
                "protocols": ["tls"],
                "tls": {
                    "root_ca_certificate": "authority.pem",
                    "listen_private_key": "key.pem",
                    "listen_certificate": "certificate.pem",
                    "connect_private_key": "key.pem",
                    "connect_certificate": "certificate.pem",
                    "enable_mtls": True,
                    "verify_name_on_connect": False,
                },
            }
        },
        "access_control": _access(holders),
    }


def _access(holders: Sequence[Holder]) -> Mapping[str, object]:
    rules: list[dict[str, object]] = list(_EVERYBODY)
    policies = []
    for number, holder in enumerate(holders):
        own = [rule for robot in holder.robots for rule in _rules(number, robot)]
        rules.extend(own)
        names = [str(rule["id"]) for rule in (*_EVERYBODY, *own)]
        policies.append({"rules": names, "subjects": [f"holder {number}"]})
    subjects = [
        {"id": f"holder {number}", "cert_common_names": [holder.name]}
        for number, holder in enumerate(holders)
    ]
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


def _rules(number: int, robot: str) -> tuple[dict[str, object], ...]:
    """Return what comes in from the holder of a robot: questions by it, answers and signs of it."""
    id, name = f"holder {number}, {digest(robot)}", digest(robot)
    return (
        _rule(f"{id} asks", ["query"], [f"mmrs/*/*/*/from/{name}"]),
        _rule(
            f"{id} answers",
            ["reply", "declare_queryable", "put"],
            [f"mmrs/*/*/{name}/from/*", f"mmrs/*/*/{name}/state"],
        ),
        _rule(f"{id} is there", ["liveliness_token"], [f"mmrs/*/*/{name}/here/*"]),
    )


def _rule(id: str, messages: list[str], keys: list[str], flow: str = "ingress") -> dict[str, object]:
    return {"id": id, "permission": "allow", "flows": [flow], "messages": messages, "key_exprs": keys}


_EVERYTHING = [
    "put",
    "delete",
    "declare_subscriber",
    "query",
    "declare_queryable",
    "reply",
    "liveliness_token",
    "declare_liveliness_subscriber",
    "liveliness_query",
]
_LOOKING = ["declare_subscriber", "declare_liveliness_subscriber", "liveliness_query"]
_EVERYBODY = (
    _rule("goes out", _EVERYTHING, ["**"], "egress"),
    _rule("looks on", _LOOKING, ["mmrs/**"]),
    _rule("asks for states", ["query"], ["mmrs/*/*/*/state"]),
)
