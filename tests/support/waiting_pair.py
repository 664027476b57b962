"""A behaviour in which two robots wait for each other, as a file."""

PAIR = """<?xml version="1.0" encoding="UTF-8"?>
<bl:Behaviour xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:bl="urn:mmrs:behaviour:1.0" name="pair">
  <targets xsi:type="bl:RelativeCoordinate" name="here" x="0.0" y="0.0"/>
  <robots id="a" typeName="TYPE" home="//@targets.0">
    <moves xsi:type="bl:Start" name="start"/>
    <moves xsi:type="bl:HoldPosition" name="hold" duration="1.0">
      <postActions xsi:type="bl:UnicastNotify" slot="//@robots.1/@slots.0"/>AGAIN
    </moves>
    <moves xsi:type="bl:Stop" name="stop"/>
    <moveTransitions from="//@robots.0/@moves.0" to="//@robots.0/@moves.1" waitFor="//@robots.0/@slots.0"/>
    <moveTransitions from="//@robots.0/@moves.1" to="//@robots.0/@moves.2"/>
    <slots name="ready"/>
  </robots>
  <robots id="b" typeName="TYPE" home="//@targets.0">
    <moves xsi:type="bl:Start" name="start"/>
    <moves xsi:type="bl:HoldPosition" name="hold" duration="1.0">
      <preActions xsi:type="bl:UnicastNotify" slot="//@robots.0/@slots.0"/>
    </moves>
    <moves xsi:type="bl:Stop" name="stop"/>
    <moveTransitions from="//@robots.1/@moves.0" to="//@robots.1/@moves.1"/>
    <moveTransitions from="//@robots.1/@moves.1" to="//@robots.1/@moves.2" waitFor="//@robots.1/@slots.0"/>
    <slots name="go"/>
  </robots>
</bl:Behaviour>
"""

AGAIN = """
      <postActions xsi:type="bl:UnicastNotify" slot="//@robots.1/@slots.0" active="false"/>"""


def waiting_pair(type_name: str, *, taken_back: bool = False) -> str:
    """Return the file of 'a' and 'b'; `taken_back`: a's word to b is taken back after it is given."""
    return PAIR.replace("TYPE", type_name).replace("AGAIN", AGAIN if taken_back else "")


FINDING = """<?xml version="1.0" encoding="UTF-8"?>
<bl:Behaviour xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:bl="urn:mmrs:behaviour:1.0" name="pair">
  <targets xsi:type="bl:RelativeCoordinate" name="here" x="0.0" y="0.0"/>
  <robots id="a" typeName="TYPE" home="//@targets.0">
    <moves xsi:type="bl:Start" name="start"/>
    <moves xsi:type="bl:HoldPosition" name="hold" duration="3.0">
      <postActions xsi:type="bl:UnicastNotify" slot="//@robots.1/@slots.0"/>
    </moves>
    <moves xsi:type="bl:Stop" name="stop"/>
    <moveTransitions from="//@robots.0/@moves.0" to="//@robots.0/@moves.1"/>
    <moveTransitions from="//@robots.0/@moves.1" to="//@robots.0/@moves.2"/>
  </robots>
  <robots id="b" typeName="TYPE" home="//@targets.0">
    <moves xsi:type="bl:Start" name="start"/>
    <moves xsi:type="bl:HoldPosition" name="hold" duration="0.5"/>
    <moves xsi:type="bl:Stop" name="stop"/>
    <moveTransitions xsi:type="bl:Choice" from="//@robots.1/@moves.0" to="//@robots.1/@moves.1"
        waitFor="//@robots.1/@slots.0" conditionIdentifier="found:a buoy" falseBranch="//@robots.1/@moves.2"/>
    <moveTransitions from="//@robots.1/@moves.1" to="//@robots.1/@moves.2"/>
    <slots name="go"/>
  </robots>
</bl:Behaviour>
"""


def finding_pair(type_name: str) -> str:
    """Return the file of 'a', which tells 'b', whose way depends on whether somebody has found a buoy."""
    return FINDING.replace("TYPE", type_name)
