import java.util.Arrays;
import java.util.List;
import org.eclipse.emf.ecore.EAttribute;
import org.eclipse.emf.ecore.EObject;
import org.eclipse.emf.ecore.util.EcoreUtil;

/** EMF's own idea of equality, which compares arrays by identity where nobody tells it better. */
final class Equality extends EcoreUtil.EqualityHelper {
  private static final long serialVersionUID = 1L;

  @Override
  protected boolean haveEqualAttribute(EObject one, EObject other, EAttribute attribute) {
    if (attribute.getEAttributeType().getInstanceClass() != byte[].class
        || one.eIsSet(attribute) != other.eIsSet(attribute)) {
      return super.haveEqualAttribute(one, other, attribute);
    }
    Object[] mine = {one.eGet(attribute)};
    Object[] theirs = {other.eGet(attribute)};
    return attribute.isMany()
        ? Arrays.deepEquals(((List<?>) mine[0]).toArray(), ((List<?>) theirs[0]).toArray())
        : Arrays.deepEquals(mine, theirs);
  }
}
