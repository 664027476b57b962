import java.io.PrintStream;
import java.math.BigDecimal;
import java.util.ArrayList;
import java.util.Collection;
import java.util.Date;
import java.util.HexFormat;
import java.util.List;
import org.eclipse.emf.common.util.Enumerator;
import org.eclipse.emf.ecore.EDataType;
import org.eclipse.emf.ecore.EObject;
import org.eclipse.emf.ecore.EReference;
import org.eclipse.emf.ecore.EStructuralFeature;
import org.eclipse.emf.ecore.InternalEObject;
import org.eclipse.emf.ecore.resource.Resource;
import org.eclipse.emf.ecore.util.EcoreUtil;
import org.eclipse.emf.ecore.xmi.XMLResource;

/** Tells every value of a model, with all its bits. */
final class Models {
  private final Resource model;
  private final PrintStream out;

  Models(Resource model, PrintStream out) {
    this.model = model;
    this.out = out;
  }

  void print() {
    model.getContents().forEach(this::print);
  }

  private void print(EObject element) {
    String path = path(element);
    String id = ((XMLResource) model).getID(element);
    out.println("ELEMENT " + path + " " + Metamodels.name(element.eClass()) + (id == null ? "" : " id=" + id));
    for (EStructuralFeature feature : element.eClass().getEAllStructuralFeatures()) {
      boolean up = feature instanceof EReference reference && reference.isContainer();
      if (!feature.isTransient() && !up && element.eIsSet(feature)) {
        out.println("VALUE " + path + " " + feature.getName() + " " + values(element, feature));
      }
    }
    for (EObject child : element.eContents()) {
      if (((InternalEObject) child).eDirectResource() == null) {
        print(child);
      }
    }
  }

  private static List<String> values(EObject element, EStructuralFeature feature) {
    Object value = element.eGet(feature);
    List<String> told = new ArrayList<>();
    for (Object each : feature.isMany() ? (Collection<?>) value : java.util.Collections.singletonList(value)) {
      told.add(feature instanceof EReference && each != null ? path((EObject) each) : told(each, feature));
    }
    return told;
  }

  private static String told(Object value, EStructuralFeature feature) {
    if (value == null) {
      return "null";
    } else if (value instanceof Double number) {
      return String.format("%016x", Double.doubleToLongBits(number));
    } else if (value instanceof Float number) {
      return String.format("%08x", Float.floatToIntBits(number));
    } else if (value instanceof BigDecimal number) {
      return number.unscaledValue() + "E" + -number.scale();
    } else if (value instanceof Date date) {
      return Long.toString(date.getTime());
    } else if (value instanceof Character character) {
      return Integer.toString(character);
    } else if (value instanceof byte[] bytes) {
      return HexFormat.of().formatHex(bytes);
    } else if (value instanceof Enumerator literal) {
      return literal.getName();
    } else if (value instanceof Number || value instanceof Boolean) {
      return value.toString();
    }
    return quoted(EcoreUtil.convertToString((EDataType) feature.getEType(), value));
  }

  private static String quoted(String text) {
    StringBuilder codes = new StringBuilder("'");
    text.codePoints().forEach(
        code -> codes.append(code > 32 && code < 127 && code != '\\' ? Character.toString(code) : "\\" + code + ";"));
    return codes.append("'").toString();
  }

  static String path(EObject element) {
    EObject container = element.eContainer();
    Resource own = ((InternalEObject) element).eDirectResource();
    if (own != null || container == null) {
      String file = own == null ? "nowhere" : own.getURI().lastSegment();
      return file + "#" + (own == null ? "" : own.getContents().indexOf(element));
    }
    EReference feature = element.eContainmentFeature();
    String index = feature.isMany() ? "." + ((List<?>) container.eGet(feature)).indexOf(element) : "";
    return path(container) + "/" + feature.getName() + index;
  }
}
