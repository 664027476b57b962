import com.sun.management.OperatingSystemMXBean;
import java.io.File;
import java.io.OutputStream;
import java.lang.management.ManagementFactory;
import java.lang.management.ThreadMXBean;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.Map;
import org.eclipse.emf.common.util.URI;
import org.eclipse.emf.ecore.EPackage;
import org.eclipse.emf.ecore.resource.Resource;
import org.eclipse.emf.ecore.resource.ResourceSet;
import org.eclipse.emf.ecore.resource.impl.ResourceSetImpl;
import org.eclipse.emf.ecore.util.EcoreUtil;
import org.eclipse.emf.ecore.xmi.XMLResource;
import org.eclipse.emf.ecore.xmi.impl.EcoreResourceFactoryImpl;
import org.eclipse.emf.ecore.xmi.impl.XMIResourceFactoryImpl;

/**
 * Reads and writes a model with EMF, so that its time and memory can be compared with ours.
 *
 * <p>Usage: {@code EmfModels RUNS MODEL OUT ECORE...}. Each run reads MODEL with all its references, and writes it to
 * OUT, and prints {@code read WALL CPU ALL} and {@code write WALL CPU ALL}, in seconds: CPU is of the working thread, ALL
 * of the process, with its collector and compiler. After more than one run it prints {@code memory BYTES}, what the model
 * takes in the heap.
 */
public final class EmfModels {
  private static final ThreadMXBean THREADS = ManagementFactory.getThreadMXBean();

  private static final OperatingSystemMXBean PROCESS =
      (OperatingSystemMXBean) ManagementFactory.getOperatingSystemMXBean();

  private final ResourceSet resources = new ResourceSetImpl();

  public static void main(String[] arguments) throws Exception {
    EmfModels models = new EmfModels();
    for (int index = 3; index < arguments.length; index++) {
      EPackage found = (EPackage) models.read(arguments[index]).getContents().get(0);
      models.resources.getPackageRegistry().put(found.getNsURI(), found);
    }
    int runs = Integer.parseInt(arguments[0]);
    for (int run = 0; run < runs; run++) {
      models.run(arguments[1], arguments[2]);
    }
    if (runs > 1) {
      models.weigh(arguments[1]);
    }
  }

  private EmfModels() {
    Map<String, Object> factories = resources.getResourceFactoryRegistry().getExtensionToFactoryMap();
    factories.put("ecore", new EcoreResourceFactoryImpl());
    factories.put("*", new XMIResourceFactoryImpl());
  }

  private Resource read(String file) {
    return resources.getResource(URI.createFileURI(new File(file).getAbsolutePath()), true);
  }

  private Resource readWhole(String file) {
    Resource model = read(file);
    EcoreUtil.resolveAll(model);
    if (!model.getErrors().isEmpty()) {
      throw new IllegalStateException(model.getErrors().get(0).getMessage());
    }
    return model;
  }

  private void run(String file, String out) throws Exception {
    long[] begun = now();
    Resource model = readWhole(file);
    report("read", begun);
    begun = now();
    try (OutputStream stream = Files.newOutputStream(Path.of(out))) {
      model.save(stream, Map.of(XMLResource.OPTION_ENCODING, "UTF-8"));
    }
    report("write", begun);
    resources.getResources().remove(model);
  }

  private void weigh(String file) {
    long before = heap();
    Resource model = readWhole(file);
    System.out.println("memory " + (heap() - before));
    resources.getResources().remove(model);
  }

  private static long heap() {
    for (int round = 0; round < 3; round++) {
      System.gc();
    }
    return Runtime.getRuntime().totalMemory() - Runtime.getRuntime().freeMemory();
  }

  private static long[] now() {
    return new long[] {System.nanoTime(), THREADS.getCurrentThreadCpuTime(), PROCESS.getProcessCpuTime()};
  }

  private static void report(String what, long[] begun) {
    long[] ended = now();
    System.out.print(what);
    for (int clock = 0; clock < ended.length; clock++) {
      System.out.print(" " + (ended[clock] - begun[clock]) / 1e9);
    }
    System.out.println();
  }
}
