"""Copies an SSP package and tells OMSimulator what its systems are for: `python3 annotate.py IN.ssp OUT.ssp`."""

import sys
import zipfile
from pathlib import Path

# In SSP 1.0 a system ends with its annotations.
ANNOTATION = """\
    <ssd:Annotations>
      <ssc:Annotation type="org.openmodelica">
        <oms:Annotations xmlns:oms="https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd">
          <oms:SimulationInformation>
            <oms:FixedStepMaster description="oms-ma" stepSize="0.001" relativeTolerance="1e-6" />
          </oms:SimulationInformation>
        </oms:Annotations>
      </ssc:Annotation>
    </ssd:Annotations>
  </ssd:System>"""


def annotate(package: Path, copy: Path) -> None:
    """Writes `copy`, with an annotation in every system structure of `package`."""
    with zipfile.ZipFile(package) as source, zipfile.ZipFile(copy, "w", zipfile.ZIP_DEFLATED) as target:
        for name in source.namelist():
            content = source.read(name)
            if name.endswith(".ssd"):
                content = content.decode().replace("</ssd:System>", ANNOTATION).encode()
            target.writestr(name, content)


if __name__ == "__main__":
    annotate(Path(sys.argv[1]), Path(sys.argv[2]))
